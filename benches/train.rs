//! One vehicle of ten degrees of freedom over 163 m of ballasted track with a bridge of 48 m, 3,900 steps of 1 ms, by
//! contact law; and how the cost grows with the cars and with the track. Throughput is in crossings.

mod cpu;

use cpu::CpuTime;
use criterion::{
    BenchmarkId, Criterion, SamplingMode, Throughput, criterion_group, criterion_main,
};
use dpim::ensemble::{Points, Strip, System, TRAIN_LANES, Trains};
use dpim::quantity::Quantity;
use dpim::system::InitialState;
use dpim::system::train::{
    Ballast, Car, Contact, Deck, DeckDamping, Fastener, OnBridge, PlacedCar, Rail, RailVehicle,
    Spans, Support, Track, TrainCrossing,
};

const HERTZ: Contact = Contact::Hertz {
    constant: 4.2206e-8,
};
const STEPS: usize = 3899;
const SPEED: f64 = 120.0 / 3.6;

/// Zeng et al. 2014, Table 1, trailer.
fn trailer() -> RailVehicle {
    RailVehicle {
        body_mass: 44_000.0,
        body_pitch_inertia: 2.7e6,
        bogie_mass: 2400.0,
        bogie_pitch_inertia: 2200.0,
        wheelset_mass: 2400.0,
        primary_stiffness: 1.4e6,
        primary_damping: 8e4,
        secondary_stiffness: 6e5,
        secondary_damping: 8e4,
        bogie_spacing: 17.375,
        wheelbase: 2.5,
        wheel_radius: 0.46,
        wheel_defects: Vec::new(),
    }
}

/// Track of this length (m) that ends beyond the last place of the first wheel.
fn crossing(contact: Contact, cars: usize, track: f64) -> TrainCrossing {
    let ballast = Fastener {
        stiffness: 2.755e8,
        damping: 1.176e5,
    };
    let fasteners = (track / 0.6) as usize + 1;
    let end = 180;
    TrainCrossing {
        cars: (0..cars)
            .map(|k| PlacedCar {
                car: Car::RailVehicle(trailer()),
                behind: 24.275 * k as f64,
            })
            .collect(),
        contact,
        track: Some(Track {
            start: (end - fasteners as i64) as f64 * 0.6,
            fasteners,
            spacing: 0.6,
            elements: 1,
            rail: Rail {
                flexural_rigidity: 1.325e7,
                mass_per_length: 121.28,
            },
            fastener: Fastener {
                stiffness: 1.3e8,
                damping: 1.5e5,
            },
            support: Support::Ballasted(Ballast {
                sleeper_mass: 251.0,
                ballast_mass: 1062.8,
                ballast,
                subgrade: Fastener {
                    stiffness: 1.55e8,
                    damping: 6.23e4,
                },
                on_bridge: OnBridge {
                    bed: ballast,
                    mass: 1062.8,
                },
            }),
            window: Some(8.0),
        }),
        deck: Some(Deck {
            spans: vec![48.0],
            kind: Spans::Simple,
            mass_per_length: 40_000.0,
            flexural_rigidity: 1.5e12,
            shear_rigidity: None,
            section_modulus: None,
            damping: DeckDamping::Ratio(0.01),
            modes: 10,
            bearings: None,
            sections: Vec::new(),
        }),
        speed: SPEED,
        approach: 30.0,
        gravity: 9.81,
        time_step: 1e-3,
        steps: STEPS,
        record_every: 1,
        initial_state: InitialState::Profile,
    }
}

fn bench(criterion: &mut Criterion<CpuTime>, name: &str, id: &str, case: TrainCrossing) {
    let quantities = [
        "bridge/midspan/displacement",
        "bridge/midspan/acceleration",
        "vehicle/car-1/body/acceleration",
        "vehicle/car-1/wheel-1/contact_force",
    ]
    .map(|name| Quantity::named(name).expect("a quantity"));
    let count = 1400;
    let rows: Vec<f64> = (0..count * TRAIN_LANES)
        .map(|k| 1e-4 * (0.3 * k as f64).sin())
        .collect();
    let grid = (-160.0, 0.2, count);
    let trains = Trains::new(case, &quantities, grid).expect("a crossing");
    let points = Points {
        excitation: &rows,
        samples: count,
        parameters: &[],
        range: 0..TRAIN_LANES,
    };
    let mut out = vec![0.0; trains.times().len() * trains.outputs() * TRAIN_LANES];
    let mut stepper = trains.stepper();
    let mut group = criterion.benchmark_group(name);
    group.sampling_mode(SamplingMode::Flat);
    group.sample_size(10);
    group.throughput(Throughput::Elements(TRAIN_LANES as u64));
    group.bench_function(BenchmarkId::from_parameter(id), |bencher| {
        bencher.iter(|| {
            let mut strips = Strip::cut(&mut out, TRAIN_LANES, TRAIN_LANES);
            stepper.run(&points, &mut strips[0]).expect("bounded");
        });
    });
    group.finish();
}

fn train(criterion: &mut Criterion<CpuTime>) {
    for (id, contact) in [
        ("hertz", HERTZ),
        ("linear", Contact::Linear { stiffness: 2.8e9 }),
        ("rigid", Contact::Rigid),
    ] {
        bench(criterion, "contact", id, crossing(contact, 1, 163.0));
    }
    for cars in [1, 2, 4] {
        let case = crossing(HERTZ, cars, 260.0);
        bench(criterion, "cars", &cars.to_string(), case);
    }
    for length in [163.0, 326.0, 652.0] {
        let case = crossing(HERTZ, 1, length);
        bench(criterion, "metres", &length.to_string(), case);
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().with_measurement(CpuTime);
    targets = train
}
criterion_main!(benches);
