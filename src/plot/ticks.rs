//! Where an axis has its ticks, and what stands there.

/// The ticks of an axis. The number at a tick is its label times 10 to the `exponent`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    /// Ascending.
    pub values: Vec<f64>,
    /// One for each value; empty where there is no room for a number.
    pub labels: Vec<String>,
    /// Between the ticks, without a number; only logarithmic axes have them.
    pub minor: Vec<f64>,
    /// A power of ten taken out of all labels.
    pub exponent: i32,
}

/// Ticks at multiples of 1, 2 or 5 times a power of ten from `low` to `high`: at most `most` of them,
/// but at least two.
pub(super) fn linear(low: f64, high: f64, most: usize) -> Ticks {
    let (digit, power) = step(low, high, most.max(2));
    // Integers times a power of ten: no sum of rounding errors.
    let unit = f64::from(digit) * power_of_ten(power);
    let (first, last) = multiples(low, high, unit);
    let exponent = common_exponent(low.abs().max(high.abs()), power);
    let decimals = (exponent - power).max(0) as usize;
    let mut ticks = Ticks {
        values: Vec::new(),
        labels: Vec::new(),
        minor: Vec::new(),
        exponent,
    };
    for multiple in first..=last {
        let mantissa = multiple * i64::from(digit);
        ticks
            .values
            .push(times_power_of_ten(mantissa as f64, power));
        let shown = times_power_of_ten(mantissa as f64, power - exponent);
        ticks.labels.push(minus(&format!("{shown:.decimals$}")));
    }
    ticks
}

/// Ticks at whole powers of ten, and minor ticks at 2 to 9 times them; where there are fewer than
/// two powers, also at 2 and 5 times them. `low` and `high` are positive.
pub(super) fn logarithmic(low: f64, high: f64, most: usize) -> Ticks {
    let slack = 1.0 + 1e-9;
    let inside = |value: f64| value >= low / slack && value <= high * slack;
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let whole: Vec<i32> = powers
        .clone()
        .filter(|&p| inside(power_of_ten(p)))
        .collect();
    let every = whole.len().div_ceil(most.max(2)).max(1) as i32;
    let mut ticks = Ticks {
        values: Vec::new(),
        labels: Vec::new(),
        minor: Vec::new(),
        exponent: 0,
    };
    for power in powers {
        for digit in 1..=9_u32 {
            let value = times_power_of_ten(f64::from(digit), power);
            if !inside(value) {
                continue;
            }
            let numbered = match digit {
                1 => power.rem_euclid(every) == 0,
                2 | 5 => whole.len() < 2,
                _ => false,
            };
            if numbered {
                ticks.values.push(value);
                ticks.labels.push(power_label(digit, power));
            } else if every == 1 || digit == 1 {
                ticks.minor.push(value);
            }
        }
    }
    ticks
}

/// `value` to three significant digits, for a sentence: `0.126`, `−94.5`, `3.1·10^{−7}`.
pub(super) fn in_words(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let power = value.abs().log10().floor() as i32;
    if (-3..5).contains(&power) {
        let decimals = (2 - power).max(0) as usize;
        let text = format!("{value:.decimals$}");
        let short = match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.'),
            false => text.as_str(),
        };
        return minus(short);
    }
    let (mantissa, power) = match format!("{value:.2e}").split_once('e') {
        Some((mantissa, power)) => (mantissa.to_owned(), power.to_owned()),
        None => return minus(&value.to_string()),
    };
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    format!("{}·10^{{{}}}", minus(mantissa), minus(&power))
}

/// A power of ten as it stands beside an axis: `×10^{−5}`.
pub(super) fn exponent_label(exponent: i32) -> String {
    minus(&format!("×10^{{{exponent}}}"))
}

fn power_label(digit: u32, power: i32) -> String {
    match (digit, power) {
        (digit, 0) => digit.to_string(),
        (1, 1) => "10".to_owned(),
        (1, power) => minus(&format!("10^{{{power}}}")),
        (digit, power) => minus(&format!("{digit}·10^{{{power}}}")),
    }
}

/// The proper minus sign.
fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// The smallest step of 1, 2 or 5 times a power of ten that gives at most `most` ticks; the one before
/// it where that gives a single tick, which would not say how long a step is.
fn step(low: f64, high: f64, most: usize) -> (u32, i32) {
    let rough = (high - low) / most as f64;
    let mut power = rough.log10().floor() as i32 - 1;
    let mut before = (1, power);
    loop {
        for digit in [1, 2, 5] {
            let (first, last) = multiples(low, high, times_power_of_ten(f64::from(digit), power));
            if last - first < most as i64 {
                return if last > first { (digit, power) } else { before };
            }
            before = (digit, power);
        }
        power += 1;
    }
}

/// The first and the last multiple of `unit` from `low` to `high`, with room for rounding errors.
fn multiples(low: f64, high: f64, unit: f64) -> (i64, i64) {
    let slack = 1e-9 * (high - low) / unit;
    let (first, last) = (low / unit - slack, high / unit + slack);
    (first.ceil() as i64, last.floor() as i64)
}

/// The power of ten that labels leave out: none where they are short as they are.
fn common_exponent(largest: f64, power_of_step: i32) -> i32 {
    let power = largest.log10().floor() as i32;
    if power >= 5 || (power < -1 && power_of_step < -3) {
        power
    } else {
        0
    }
}

fn power_of_ten(power: i32) -> f64 {
    times_power_of_ten(1.0, power)
}

/// Correctly rounded where the power is within 22: powers of ten up to that are exact.
fn times_power_of_ten(value: f64, power: i32) -> f64 {
    if power < 0 {
        value / 10_f64.powi(-power)
    } else {
        value * 10_f64.powi(power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(label: &str) -> f64 {
        label.replace('−', "-").parse().unwrap()
    }

    #[test]
    fn every_label_is_the_exact_value_of_its_tick() {
        let ranges = [
            (0.0, 2.0),
            (-94.5, 3.2),
            (-1e-7, 3e-7),
            (0.3, 0.3001),
            (1e6, 5e6),
            (-0.052, 0.048),
            (1e-12, 9e-12),
        ];
        for (low, high) in ranges {
            for most in 2..12 {
                let ticks = linear(low, high, most);
                assert!(ticks.values.len() <= most.max(5), "{low} {high} {most}");
                assert!(ticks.values.len() >= 2, "{low} {high} {most}");
                for (value, label) in ticks.values.iter().zip(&ticks.labels) {
                    let text = format!("{}e{}", label.replace('−', "-"), ticks.exponent);
                    assert_eq!(text.parse::<f64>().unwrap(), *value, "{label}");
                    assert!(*value >= low - 1e-8 * (high - low));
                    assert!(*value <= high + 1e-8 * (high - low));
                }
            }
        }
    }

    #[test]
    fn ticks_are_evenly_spaced_and_ends_belong() {
        let ticks = linear(0.0, 2.0, 11);
        assert_eq!(
            ticks.labels,
            [
                "0.0", "0.2", "0.4", "0.6", "0.8", "1.0", "1.2", "1.4", "1.6", "1.8", "2.0"
            ]
        );
        assert_eq!(
            linear(-100.0, 0.0, 6).labels,
            ["−100", "−80", "−60", "−40", "−20", "0"]
        );
        assert_eq!(linear(0.0, 2e-7, 3).exponent, -7);
        assert_eq!(linear(0.0, 2e-7, 3).labels, ["0", "1", "2"]);
    }

    #[test]
    fn zero_has_no_sign() {
        for label in linear(-0.3, 0.3, 7).labels {
            assert!(read(&label) != 0.0 || !label.contains('−'), "{label}");
        }
    }

    #[test]
    fn decades_are_numbered_and_their_multiples_marked() {
        let ticks = logarithmic(1e-6, 1e-3, 8);
        assert_eq!(ticks.labels, ["10^{−6}", "10^{−5}", "10^{−4}", "10^{−3}"]);
        assert_eq!(ticks.values, [1e-6, 1e-5, 1e-4, 1e-3]);
        assert_eq!(ticks.minor.len(), 3 * 8);
    }

    #[test]
    fn many_decades_are_thinned_and_a_part_of_one_has_numbers() {
        let ticks = logarithmic(1e-20, 1.0, 6);
        assert!(ticks.labels.len() <= 6 && ticks.labels.len() >= 4);
        let part = logarithmic(1.5, 8.0, 6);
        assert_eq!(part.labels, ["2", "5"]);
        assert_eq!(part.minor, [3.0, 4.0, 6.0, 7.0, 8.0]);
    }

    #[test]
    fn numbers_in_a_sentence() {
        let written = [0.0, 0.1264, -94.49, 984.0, 3.1e-7, -2.0e9, 0.5].map(in_words);
        assert_eq!(
            written,
            [
                "0",
                "0.126",
                "−94.5",
                "984",
                "3.1·10^{−7}",
                "−2·10^{9}",
                "0.5"
            ]
        );
    }
}
