//! Units as they stand in a picture: a fitting prefix, and powers raised.

/// What an axis shows: its name (`Displacement at midspan`), symbol (`y`) and SI unit (`m`, `m/s2`;
/// `1` or nothing where there is none). Name and symbol may have `_{}` and `^{}` in them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Label<'a> {
    pub name: &'a str,
    pub symbol: &'a str,
    pub unit: &'a str,
}

/// A unit to show values in: `shown = factor * SI value`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unit {
    pub factor: f64,
    /// Marked-up text; empty for none.
    pub text: String,
}

/// The largest value that a prefixed unit is used for, its factor and its text.
type Choice = (f64, f64, &'static str);

/// Units that take a prefix.
const PREFIXES: [(&str, &[Choice]); 4] = [
    (
        "m",
        &[
            (2e-6, 1e6, "µm"),
            (2.0, 1e3, "mm"),
            (f64::INFINITY, 1.0, "m"),
        ],
    ),
    (
        "N",
        &[
            (2e3, 1.0, "N"),
            (2e6, 1e-3, "kN"),
            (f64::INFINITY, 1e-6, "MN"),
        ],
    ),
    (
        "N m",
        &[
            (2e3, 1.0, "N·m"),
            (2e7, 1e-3, "kN·m"),
            (f64::INFINITY, 1e-6, "MN·m"),
        ],
    ),
    (
        "Pa",
        &[
            (2e3, 1.0, "Pa"),
            (2e5, 1e-3, "kPa"),
            (f64::INFINITY, 1e-6, "MPa"),
        ],
    ),
];

impl Unit {
    /// The unit that suits values up to `largest` (SI).
    pub(super) fn suiting(unit: &str, largest: f64) -> Self {
        let choices = PREFIXES
            .iter()
            .find(|(name, _)| *name == unit)
            .map(|(_, choices)| choices);
        let choice = choices.and_then(|choices| choices.iter().find(|choice| largest <= choice.0));
        match choice {
            Some(&(_, factor, text)) => Unit {
                factor,
                text: text.to_owned(),
            },
            None => Unit {
                factor: 1.0,
                text: raised(unit),
            },
        }
    }

    /// The unit of a density over values in this unit.
    pub(super) fn inverse(&self) -> Unit {
        let text = match self.text.as_str() {
            "" => String::new(),
            simple if simple.chars().all(char::is_alphabetic) => format!("{simple}^{{−1}}"),
            compound => match compound.split_once('/') {
                Some((above, below)) if !below.contains(['/', '·']) => format!("{below}/{above}"),
                Some(_) | None => format!("({compound})^{{−1}}"),
            },
        };
        Unit {
            factor: 1.0 / self.factor,
            text,
        }
    }
}

/// A value of this SI unit for a sentence, in the unit that suits it: `95.5 mm`.
pub fn with_unit(value: f64, unit: &str) -> String {
    let unit = Unit::suiting(unit, value.abs());
    // Twelve digits: the factor adds no others.
    let digits = format!("{:.11e}", unit.factor * value);
    let shown: f64 = digits.parse().unwrap_or(unit.factor * value);
    let number = shown.to_string().replace('-', "−");
    if unit.text.is_empty() {
        number
    } else {
        format!("{number}\u{a0}{}", unit.text)
    }
}

/// `name, symbol (unit)`, without what is empty.
pub(super) fn axis_label(name: &str, symbol: &str, unit: &Unit) -> String {
    let mut text = name.to_owned();
    if !symbol.is_empty() {
        text = format!("{text}, {symbol}");
    }
    if !unit.text.is_empty() {
        text = format!("{text} ({})", unit.text);
    }
    text
}

/// `m/s2` as `m/s^{2}`, `N m` as `N·m`.
fn raised(unit: &str) -> String {
    if unit == "1" {
        return String::new();
    }
    let mut text = String::new();
    let mut after_letter = false;
    for character in unit.chars() {
        match character {
            digit if digit.is_ascii_digit() && after_letter => {
                text.push_str(&format!("^{{{digit}}}"));
            }
            ' ' => text.push('·'),
            other => text.push(other),
        }
        after_letter = character.is_alphabetic();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_suit_the_values() {
        let text = |unit, largest| Unit::suiting(unit, largest).text;
        assert_eq!(text("m", 0.0945), "mm");
        assert_eq!(text("m", 40.0), "m");
        assert_eq!(text("Pa", 2.1e8), "MPa");
        assert_eq!(text("m/s2", 0.5), "m/s^{2}");
        assert_eq!(text("1", 0.5), "");
    }

    #[test]
    fn a_value_in_a_sentence_keeps_its_digits() {
        assert_eq!(with_unit(0.0955, "m"), "95.5\u{a0}mm");
        assert_eq!(with_unit(-0.0123457, "m"), "−12.3457\u{a0}mm");
        assert_eq!(with_unit(1.1, "m/s2"), "1.1\u{a0}m/s^{2}");
        assert_eq!(with_unit(0.6, "1"), "0.6");
    }

    #[test]
    fn factor_and_prefix_agree() {
        let prefix = |text: &str| match text.chars().next() {
            Some('µ') => 1e-6,
            Some('m') if text.len() > 1 => 1e-3,
            Some('k') => 1e3,
            Some('M') => 1e6,
            _ => 1.0,
        };
        for (_, choices) in PREFIXES {
            for &(_, factor, text) in choices {
                assert!((factor * prefix(text) - 1.0).abs() < 1e-12, "{text}");
            }
        }
    }

    #[test]
    fn a_density_has_the_inverse_unit() {
        let text = |unit, largest| Unit::suiting(unit, largest).inverse().text;
        assert_eq!(text("m", 0.1), "mm^{−1}");
        assert_eq!(text("m/s2", 0.1), "s^{2}/m");
        assert_eq!(text("N m", 1e5), "(kN·m)^{−1}");
        assert_eq!(text("", 1.0), "");
        assert_eq!(Unit::suiting("m", 0.1).inverse().factor, 1e-3);
    }
}
