//! Coordinates and paths as SVG text, to a tenth of a pixel and as short as they get.

fn tenths(value: f64) -> i64 {
    // Far outside the page is as good as a little outside; `as` keeps within bounds.
    (value.clamp(-1e6, 1e6) * 10.0).round() as i64
}

/// A coordinate to a tenth, as short as it gets.
pub(super) fn number(value: f64) -> String {
    short(tenths(value))
}

fn short(tenths: i64) -> String {
    let sign = if tenths < 0 { "-" } else { "" };
    let (whole, rest) = (tenths.abs() / 10, tenths.abs() % 10);
    match (whole, rest) {
        (0, 0) => "0".to_owned(),
        (whole, 0) => format!("{sign}{whole}"),
        (0, rest) => format!("{sign}.{rest}"),
        (whole, rest) => format!("{sign}{whole}.{rest}"),
    }
}

/// The path through `points`, by relative steps: short, and without any sum of rounding errors.
pub(super) fn path_data(points: &[(f64, f64)]) -> String {
    let mut data = String::with_capacity(10 * points.len());
    let mut last = (0, 0);
    for (index, &(x, y)) in points.iter().enumerate() {
        let here = (tenths(x), tenths(y));
        let step = (here.0 - last.0, here.1 - last.1);
        match index {
            0 => data.push('M'),
            1 => data.push('l'),
            _ if step.0 >= 0 => data.push(' '),
            _ => {}
        }
        data.push_str(&short(step.0));
        if step.1 >= 0 {
            data.push(' ');
        }
        data.push_str(&short(step.1));
        last = here;
    }
    data
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short() {
        let written = [0.0, -0.04, 0.5, -0.5, 12.0, -3.25, 100.04].map(number);
        assert_eq!(written, ["0", "0", ".5", "-.5", "12", "-3.3", "100"]);
    }

    #[test]
    fn path_steps_add_up_to_the_points() {
        let points: Vec<(f64, f64)> = (0..100)
            .map(|i| (f64::from(i) / 3.0, (f64::from(i)).sin() * 50.0))
            .collect();
        let data = path_data(&points);
        let spaced = data.replace('-', " -").replace(['M', 'l'], " ");
        let steps: Vec<f64> = spaced
            .split_whitespace()
            .map(|s| s.parse().unwrap())
            .collect();
        let mut here = (0.0, 0.0);
        for (point, step) in points.iter().zip(steps.chunks(2)) {
            here = (here.0 + step[0], here.1 + step[1]);
            assert!((here.0 - point.0).abs() <= 0.05 + 1e-9);
            assert!((here.1 - point.1).abs() <= 0.05 + 1e-9);
        }
        assert_eq!(steps.len(), 200);
    }
}
