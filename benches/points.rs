//! Standard normals of each rule: 100,000 points in 1024 variables, block by block of 512 points as
//! `excite` draws them, and what it takes to build each rule before.

mod cpu;

use cpu::CpuTime;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dpim::probability::{
    GfDiscrepancy, LatinHypercube, LatinizedPartiallyStratified, MomentMatched, MonteCarlo,
    PartiallyStratified, PointRule, RankOneLattice, Sobol,
};
use std::hint::black_box;
use std::time::Duration;

const VARIABLES: usize = 1024;
const BLOCK: usize = 512;

type Build = fn(usize) -> Box<dyn PointRule>;

const RULES: [(&str, Build); 8] = [
    ("monte-carlo", |n| {
        Box::new(MonteCarlo::new(n, VARIABLES, 1))
    }),
    ("latin-hypercube", |n| {
        Box::new(LatinHypercube::new(n, VARIABLES, 1))
    }),
    ("sobol", |n| Box::new(Sobol::new(n, VARIABLES, 1).unwrap())),
    ("lattice", |n| {
        Box::new(RankOneLattice::new(n, VARIABLES, 1).unwrap())
    }),
    ("partially-stratified", |n| {
        Box::new(PartiallyStratified::new(n, None, VARIABLES, 0, 1).unwrap())
    }),
    ("latinized-partially-stratified", |n| {
        let square = n.isqrt() * n.isqrt();
        Box::new(LatinizedPartiallyStratified::new(square, VARIABLES, 0, 1).unwrap())
    }),
    ("gf-discrepancy", |n| {
        Box::new(GfDiscrepancy::new(n, VARIABLES).unwrap())
    }),
    ("sobol-matched-50", |n| {
        let rule = Box::new(Sobol::new(n, VARIABLES, 1).unwrap());
        Box::new(MomentMatched::new(rule, 50).unwrap())
    }),
];

fn points(criterion: &mut Criterion<CpuTime>) {
    let mut group = criterion.benchmark_group("points");
    group.throughput(Throughput::Elements((BLOCK * VARIABLES) as u64));
    let mut normals = vec![0.0; BLOCK * VARIABLES];
    for (name, build) in RULES {
        let rule = build(100_000);
        let blocks = rule.count() / BLOCK;
        let mut block = 0;
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                block = (block + 1) % blocks;
                rule.standard_normals(block * BLOCK..(block + 1) * BLOCK, &mut normals);
            });
        });
    }
    group.finish();
}

/// Of 984 points; parts that run on other threads are not counted here.
fn building(criterion: &mut Criterion<CpuTime>) {
    let mut group = criterion.benchmark_group("building");
    for (name, build) in RULES {
        group.bench_function(name, |bencher| {
            bencher.iter(|| black_box(build(984)).count());
        });
    }
    group.bench_function("gf-discrepancy-cells-1000-6", |bencher| {
        bencher.iter(|| GfDiscrepancy::new(1000, 6).unwrap().count());
    });
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .with_measurement(CpuTime)
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_secs(1));
    targets = points, building
}
criterion_main!(benches);
