//! Responses that grow without bound stop the run, and say where.

use crate::foreign::Points;
use crate::harness::Folder;

/// Splits `point N: ... at t = T s; reason` into its parts.
fn parts(error: &str) -> (usize, f64, &str) {
    let (point, rest) = error
        .split_once(": the response grows without bound, beyond 1000 km at t = ")
        .expect(error);
    let (time, reason) = rest.split_once(" s; ").expect(error);
    let point = point.strip_prefix("point ").expect(error);
    (point.parse().unwrap(), time.parse().unwrap(), reason)
}

#[test]
fn a_step_too_long_for_the_cubic_stiffness() {
    let folder = Folder::with_points();
    let line = "simulate -s scenario.toml points.parquet --set vehicle.suspension_cubic_stiffness=1e14 -o out";
    let outcome = folder.run_in_vain(line, 1);
    let (point, time, reason) = parts(outcome.error());
    assert!(point < 34 && time > 0.0 && time <= 2.0, "{point} {time}");
    assert_eq!(
        reason,
        "the time step is likely too long for the nonlinear suspension: make simulation.time_step smaller"
    );
}

#[test]
fn an_irregularity_far_too_large() {
    let folder = Folder::new();
    // One road of all is 1e12 m high in places; the others are smooth.
    let mut points = Points::new(40);
    let positions = points.positions;
    points.heights[23 * positions..24 * positions]
        .iter_mut()
        .enumerate()
        .for_each(|(k, height)| *height = if k % 2 == 0 { 1e12 } else { -1e12 });
    points.write(&folder.path("points.parquet"));
    let line = "simulate -s scenario.toml points.parquet -o out";
    let outcome = folder.run_in_vain(line, 1);
    let (point, time, reason) = parts(outcome.error());
    assert!(point == 23 && time < 0.5, "{point} {time}");
    assert_eq!(
        reason,
        "the irregularity is likely far too large: look at the points file"
    );
}
