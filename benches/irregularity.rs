//! The field's sums for 512 wavenumbers on 200 positions, coefficients given, by both methods.

mod cpu;

use cpu::CpuTime;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dpim::irregularity::{
    FilterForm, Grid, Method, SecondOrderFilter, SpectralRepresentation, Synthesis,
};
use dpim::probability::{MonteCarlo, PointRule};

fn irregularity(criterion: &mut Criterion<CpuTime>) {
    let spectrum = SecondOrderFilter {
        alpha: 0.1,
        beta: 0.1,
        gamma: 1e-4,
        form: FilterForm::Corrected,
    };
    let field = SpectralRepresentation::new(&spectrum, 10.0, 512);
    let grid = Grid {
        start: 0.0,
        spacing: 0.2,
        count: 200,
    };
    let points = 512;
    let variables = 2 * field.amplitudes().len();
    let mut coefficients = vec![0.0; variables * points];
    MonteCarlo::new(points, variables, 1).standard_normals(0..points, &mut coefficients);
    let mut out = vec![0.0; points * grid.count];
    let mut group = criterion.benchmark_group("irregularity");
    group.throughput(Throughput::Elements(points as u64));
    for method in [Method::MatrixProduct, Method::ChirpTransform] {
        let synthesis = Synthesis::by(method, &field, grid);
        group.bench_function(format!("{method:?}-512-200"), |bencher| {
            bencher.iter(|| synthesis.add(&coefficients, points, &mut out));
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(CpuTime);
    targets = irregularity
}
criterion_main!(benches);
