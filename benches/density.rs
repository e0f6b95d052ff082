//! Densities of 984 points at 201 times on 512 nodes by each rule of smoothing, and of 100,000 points.

mod cpu;

use cpu::CpuTime;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dpim::Result;
use dpim::density::{
    CellKernel, Grid, KnownPoints, Options, Smoother, Smoothing, WidthRule, estimate,
};
use dpim::probability::{MonteCarlo, PointRule};
use dpim::response::{Block, Responses};

const TIMES: usize = 201;
const NODES: usize = 512;

/// Responses in memory, `[time][point]`.
struct Held {
    times: Vec<f64>,
    probability: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl Held {
    /// Smooth functions of each point's variables.
    fn new(points: &KnownPoints) -> Self {
        let at = |k: usize| {
            let t = 0.05 * k as f64;
            let of =
                |x: &[f64]| (1.0 + 0.1 * x[x.len() - 1]) * (3.0 * t + 0.3 * t * x[0]).cos() + x[0];
            points.variables.chunks(points.dimensions).map(of).collect()
        };
        Held {
            times: (0..TIMES).map(|k| 0.05 * k as f64).collect(),
            probability: vec![1.0 / points.count as f64; points.count],
            values: (0..TIMES).map(at).collect(),
        }
    }
}

impl Responses for Held {
    fn times(&self) -> &[f64] {
        &self.times
    }

    fn probability(&self) -> &[f64] {
        &self.probability
    }

    fn scan(
        &self,
        quantities: &[usize],
        visit: &mut dyn FnMut(&[Block<'_>]) -> Result<()>,
    ) -> Result<()> {
        for (time, values) in self.values.iter().enumerate() {
            visit(&[Block {
                quantity: quantities[0],
                time,
                first_point: 0,
                values,
            }])?;
        }
        Ok(())
    }
}

fn points(count: usize, dimensions: usize) -> KnownPoints {
    let mut columns = vec![0.0; count * dimensions];
    MonteCarlo::new(count, dimensions, 1).standard_normals(0..count, &mut columns);
    let point = |q: usize| (0..dimensions).map(move |d| (d, q));
    KnownPoints {
        variables: (0..count)
            .flat_map(point)
            .map(|(d, q)| columns[d * count + q])
            .collect(),
        count,
        probability: vec![1.0 / count as f64; count],
        dimensions,
        all: Some(dimensions),
    }
}

fn density(criterion: &mut Criterion<CpuTime>) {
    // The clock is the thread's: everything runs on it.
    let threads = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .use_current_thread();
    threads.build_global().expect("no pool yet");
    let mut group = criterion.benchmark_group("density");
    group.sample_size(10);
    let width = Smoothing::Width;
    let cells = Smoothing::CellImage;
    let cases = [
        (984, 2, width(WidthRule::Silverman)),
        (984, 2, width(WidthRule::Factor(0.02))),
        (984, 2, width(WidthRule::SheatherJones)),
        (984, 2, Smoothing::VarianceCorrected),
        (984, 2, Smoothing::Adaptive),
        (984, 1, cells(CellKernel::Quadratic)),
        (984, 1, cells(CellKernel::Gaussian)),
        (984, 2, cells(CellKernel::Quadratic)),
        (100_000, 2, width(WidthRule::Silverman)),
        (100_000, 2, width(WidthRule::Fixed(0.05))),
    ];
    let options = Options {
        points_per_time: NODES,
        grid: Grid::Own,
    };
    for (count, dimensions, smoothing) in cases {
        let points = points(count, dimensions);
        let held = Held::new(&points);
        group.throughput(Throughput::Elements((count * TIMES) as u64));
        let name = format!("{smoothing:?}-{count}-{dimensions}");
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                let smoother = Smoother::new(smoothing, Some(&points)).expect("a rule for these");
                estimate(&held, &[0], &smoother, options, |_| Ok(())).expect("densities");
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(CpuTime);
    targets = density
}
criterion_main!(benches);
