//! Colours that stay apart for colour-blind readers.

/// A colour: red, green and blue, 0 to 255.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Colour(pub u8, pub u8, pub u8);

pub(super) const BLACK: Colour = Colour(0, 0, 0);
pub(super) const WHITE: Colour = Colour(255, 255, 255);
/// Text that steps back: subtitles.
pub(super) const DARK_GREY: Colour = Colour(70, 70, 70);
/// Lines of the grid.
pub(super) const LIGHT_GREY: Colour = Colour(222, 222, 222);
/// Where there is no density to show.
pub(super) const BLANK: Colour = Colour(238, 238, 238);

pub(super) const BLUE: Colour = Colour(0, 114, 178);
pub(super) const SKY: Colour = Colour(86, 180, 233);
pub(super) const VERMILLION: Colour = Colour(213, 94, 0);

/// Okabe and Ito's palette, ordered for lines on white (its yellow is too light there).
/// Source: M. Okabe, K. Ito, Color Universal Design, 2008.
const LINES: [Colour; 7] = [
    BLUE,
    VERMILLION,
    Colour(0, 158, 115),
    Colour(204, 121, 167),
    Colour(230, 159, 0),
    SKY,
    BLACK,
];

/// Every eighth colour of matplotlib's viridis (CC0, S. van der Walt, N. Smith, 2015).
const VIRIDIS: [u32; 33] = [
    0x440154, 0x470d60, 0x48186a, 0x482374, 0x472d7b, 0x453681, 0x424086, 0x3f4989, 0x3b528b,
    0x375a8d, 0x33638d, 0x2f6a8e, 0x2c728e, 0x297a8e, 0x26818e, 0x23898e, 0x21908c, 0x1f988b,
    0x1f9f88, 0x21a685, 0x28ae80, 0x31b57b, 0x3ebc74, 0x4cc26c, 0x5dc963, 0x6ece58, 0x82d34c,
    0x96d83f, 0xabdc32, 0xc0df24, 0xd5e21a, 0xeae51a, 0xfde725,
];

impl Colour {
    fn from_hexadecimal(value: u32) -> Self {
        Colour((value >> 16) as u8, (value >> 8) as u8, value as u8)
    }

    /// This colour mixed with `other`: 0 gives this one, 1 the other.
    pub(super) fn mix(self, other: Colour, part: f64) -> Colour {
        let channel = |from: u8, to: u8| {
            (f64::from(from) + part * (f64::from(to) - f64::from(from))).round() as u8
        };
        Colour(
            channel(self.0, other.0),
            channel(self.1, other.1),
            channel(self.2, other.2),
        )
    }
}

impl std::fmt::Display for Colour {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// The colour of line `index`; more lines than colours start again.
pub(super) fn line_colour(index: usize) -> Colour {
    LINES[index % LINES.len()]
}

/// The colour of line `index` of `count` in an order (times): the palette for few, viridis for many.
pub(super) fn ordered_colour(index: usize, count: usize) -> Colour {
    if count <= LINES.len() {
        line_colour(index)
    } else {
        // The brightest tenth of viridis is too light on white.
        viridis(0.9 * index as f64 / (count - 1) as f64)
    }
}

/// The colour of `fraction`, 0 (dark) to 1 (bright); values outside are clamped.
pub(super) fn viridis(fraction: f64) -> Colour {
    let place = fraction.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let left = (place as usize).min(VIRIDIS.len() - 2);
    let (low, high) = (VIRIDIS[left], VIRIDIS[left + 1]);
    Colour::from_hexadecimal(low).mix(Colour::from_hexadecimal(high), place - left as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viridis_meets_its_table_and_its_ends() {
        for (index, &value) in VIRIDIS.iter().enumerate() {
            let fraction = index as f64 / 32.0;
            assert_eq!(viridis(fraction), Colour::from_hexadecimal(value));
        }
        assert_eq!(viridis(-1.0), viridis(0.0));
        assert_eq!(viridis(2.0), viridis(1.0));
    }

    #[test]
    fn viridis_grows_lighter_all_the_way() {
        let lightness =
            |c: Colour| 0.2126 * f64::from(c.0) + 0.7152 * f64::from(c.1) + 0.0722 * f64::from(c.2);
        let steps: Vec<f64> = (0..=100)
            .map(|i| lightness(viridis(f64::from(i) / 100.0)))
            .collect();
        // A channel is rounded to whole numbers: half a step of slack.
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0] - 0.5));
    }

    #[test]
    fn a_colour_is_written_in_hexadecimal() {
        assert_eq!(Colour(0, 114, 178).to_string(), "#0072b2");
    }
}
