//! Lockstep stepping of the quarter car on a beam with ten modes: irregularities given, mid-span
//! displacement and body acceleration stored at every step. Throughput is in point-steps.

mod cpu;

use cpu::CpuTime;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use dpim::ensemble::{Batch, LANES, Strip};
use dpim::integrate::Integrator;
use dpim::quantity::{BridgeResponse, Motion, Quantity, VehiclePart};
use dpim::system::{Beam, Crossing, InitialState, QuarterCar};

fn crossing(steps: usize) -> Crossing {
    Crossing {
        beam: Beam {
            span: 40.0,
            mass_per_length: 6067.0,
            flexural_rigidity: 2.658069e9,
            section_modulus: None,
            damping_ratio: 0.0,
            modes: 10,
            sections: Vec::new(),
        },
        car: QuarterCar {
            body_mass: 12000.0,
            wheel_mass: 500.0,
            suspension_stiffness: 280e3,
            suspension_damping: 11593.10,
            suspension_cubic_stiffness: 0.0,
            suspension_quadratic_damping: 0.0,
            bump_stop: None,
            tyre_stiffness: 156e3,
            speed: 20.0,
            approach: 0.0,
        },
        integrator: Integrator::Exponential,
        time_step: 2.0 / steps as f64,
        steps,
        record_every: 1,
        initial_state: InitialState::Level,
        gravity: 9.81,
    }
}

fn stepping(criterion: &mut Criterion<CpuTime>) {
    let quantities = [
        Quantity::Bridge {
            section: "midspan".to_owned(),
            response: BridgeResponse::Motion(Motion::Displacement),
        },
        Quantity::Vehicle {
            part: VehiclePart::Body,
            motion: Motion::Acceleration,
        },
    ];
    let points = 120 * LANES;
    let mut group = criterion.benchmark_group("stepping");
    for steps in [200usize, 2000] {
        let crossing = crossing(steps - 1);
        let tables = crossing.tables(&quantities);
        let eta: Vec<f64> = (0..steps * LANES)
            .map(|k| 1e-3 * (k as f64).sin())
            .collect();
        let mut out = vec![0.0; steps * 2 * points];
        let mut batch = Batch::new(&tables);
        group.throughput(Throughput::Elements((points * steps) as u64));
        group.bench_function(format!("quarter-car-10-modes-{steps}"), |bencher| {
            bencher.iter(|| {
                for block in out.chunks_exact_mut(steps * 2 * LANES) {
                    let mut strips = Strip::cut(block, LANES, LANES);
                    batch
                        .run(
                            |range, rows| {
                                rows.copy_from_slice(&eta[range.start * LANES..range.end * LANES]);
                            },
                            &mut strips[0],
                        )
                        .expect("bounded");
                }
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(CpuTime);
    targets = stepping
}
criterion_main!(benches);
