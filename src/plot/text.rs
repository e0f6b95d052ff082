//! Text: a small markup for superscripts and subscripts, its width, and breaking it into lines.
//!
//! `10^{−4}` raises, `P_{f}` lowers; all else is written as it stands.

use skrifa::MetadataProvider;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::{FontRef, charmap::Charmap};

/// What an SVG viewer looks for; a PNG always has the first.
pub(super) const FAMILY: &str = "DejaVu Sans, Arial, sans-serif";
pub(super) static REGULAR: &[u8] = include_bytes!("fonts/DejaVuSans.ttf");
pub(super) static BOLD: &[u8] = include_bytes!("fonts/DejaVuSans-Bold.ttf");

/// The size of a superscript or subscript, relative to its text.
pub(super) const SMALL: f64 = 0.72;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Level {
    Base,
    Superscript,
    Subscript,
}

impl Level {
    /// How far its baseline lies below that of the text, relative to the size of the text.
    pub(super) fn drop(self) -> f64 {
        match self {
            Level::Base => 0.0,
            Level::Superscript => -0.38,
            Level::Subscript => 0.2,
        }
    }
}

/// A piece of text on one level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Run<'a> {
    pub text: &'a str,
    pub level: Level,
}

/// The pieces of `text` on their levels. A mark without its closing brace is ordinary text.
pub(super) fn runs(text: &str) -> Vec<Run<'_>> {
    let mut pieces = Vec::new();
    let mut base = |piece| {
        if !str::is_empty(piece) {
            let level = Level::Base;
            pieces.push(Run { text: piece, level });
        }
    };
    let opening = ["^{", "_{"].iter().filter_map(|mark| text.find(mark)).min();
    let Some(start) = opening else {
        base(text);
        return pieces;
    };
    let Some(length) = text[start..].find('}') else {
        base(text);
        return pieces;
    };
    base(&text[..start]);
    let level = match text.as_bytes()[start] {
        b'^' => Level::Superscript,
        _ => Level::Subscript,
    };
    let inside = &text[start + 2..start + length];
    pieces.push(Run {
        text: inside,
        level,
    });
    pieces.extend(runs(&text[start + length + 1..]));
    pieces
}

/// The advance widths of one of our fonts.
struct Metrics<'a> {
    characters: Charmap<'a>,
    glyphs: GlyphMetrics<'a>,
}

impl Metrics<'static> {
    fn new(weight: Weight, size: f64) -> Self {
        let data = match weight {
            Weight::Regular => REGULAR,
            Weight::Bold => BOLD,
        };
        let font = FontRef::new(data).expect("the font that travels with the program is valid");
        let location = LocationRef::default();
        Metrics {
            characters: font.charmap(),
            glyphs: font.glyph_metrics(Size::new(size as f32), location),
        }
    }

    fn width(&self, text: &str) -> f64 {
        let glyph = |character| self.characters.map(character).unwrap_or_default();
        let advance = |character| self.glyphs.advance_width(glyph(character)).unwrap_or(0.0);
        text.chars().map(|c| f64::from(advance(c))).sum()
    }
}

/// The width of marked-up text, in the unit of `size` (px). Kerning is left out.
pub(super) fn width(text: &str, size: f64, weight: Weight) -> f64 {
    let metrics = Metrics::new(weight, size);
    let factor = |level| if level == Level::Base { 1.0 } else { SMALL };
    let pieces = runs(text).into_iter();
    pieces
        .map(|run| factor(run.level) * metrics.width(run.text))
        .sum()
}

/// Breaks marked-up text at spaces into lines no wider than `limit`; a wider word is cut.
pub(super) fn wrap(text: &str, size: f64, weight: Weight, limit: f64) -> Vec<String> {
    let fits = |line: &str| width(line, size, weight) <= limit;
    let mut lines: Vec<String> = Vec::new();
    let mut line = String::new();
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        let longer = if line.is_empty() {
            word.to_owned()
        } else {
            format!("{line} {word}")
        };
        if fits(&longer) {
            line = longer;
            continue;
        }
        if !line.is_empty() {
            lines.push(std::mem::take(&mut line));
        }
        for character in word.chars() {
            line.push(character);
            if !fits(&line) && line.chars().count() > 1 {
                line.pop();
                lines.push(std::mem::replace(&mut line, character.to_string()));
            }
        }
    }
    if !line.is_empty() {
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_falls_into_levels() {
        let run = |text, level| Run { text, level };
        assert_eq!(
            runs("P_{f}(t), 10^{−4} m"),
            [
                run("P", Level::Base),
                run("f", Level::Subscript),
                run("(t), 10", Level::Base),
                run("−4", Level::Superscript),
                run(" m", Level::Base),
            ]
        );
        assert_eq!(runs("a_b ^{open"), [run("a_b ^{open", Level::Base)]);
        assert!(runs("").is_empty());
    }

    #[test]
    fn width_scales_with_size_and_adds_up() {
        let narrow = width("Time (s)", 10.0, Weight::Regular);
        let wide = width("Time (s)", 20.0, Weight::Regular);
        assert!((wide - 2.0 * narrow).abs() < 1e-3);
        let parts = width("Time ", 10.0, Weight::Regular) + width("(s)", 10.0, Weight::Regular);
        assert!((parts - narrow).abs() < 1e-3);
        assert!(width("Time (s)", 10.0, Weight::Bold) > narrow);
    }

    #[test]
    fn every_sign_that_pictures_use_is_in_the_fonts() {
        for weight in [Weight::Regular, Weight::Bold] {
            let metrics = Metrics::new(weight, 10.0);
            for sign in "0123456789−×·²³⁻±≤≥–—…→ΩσμτφÅüéЖ∞√".chars()
            {
                assert!(metrics.characters.map(sign).is_some(), "{sign}");
            }
        }
    }

    #[test]
    fn wrapped_lines_fit_and_keep_every_letter() {
        let text = "A long title of a case on a simply-supported-beam-with-a-long-name, 984 points";
        let lines = wrap(text, 20.0, Weight::Bold, 200.0);
        assert!(
            lines
                .iter()
                .all(|line| width(line, 20.0, Weight::Bold) <= 200.0)
        );
        let letters = |text: &str| text.replace(' ', "");
        assert_eq!(letters(&lines.concat()), letters(text));
    }
}
