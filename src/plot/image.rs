//! A finished picture, and its pixels.

use std::sync::{Arc, OnceLock};

use resvg::{tiny_skia, usvg};

use super::text::{BOLD, REGULAR};
use crate::{BadInput, Error, Result};

/// A PNG has at most this many pixels (4 bytes each while it is drawn).
const MOST_PIXELS: f64 = 1e8;

/// A picture as SVG text. The same input gives the same bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// The whole document, UTF-8.
    pub svg: String,
}

impl Image {
    /// The picture as PNG bytes, `scale` pixels for each pixel of the page (2 for print).
    /// Drawn with the font that travels with the program: the same on every machine.
    ///
    /// # Errors
    /// [`Error::Input`] where `scale` is not positive or gives too large a picture.
    pub fn to_png(&self, scale: f64) -> Result<Vec<u8>> {
        let tree = parse(&self.svg)?;
        let size = tree.size();
        let wide = (f64::from(size.width()) * scale).ceil();
        let high = (f64::from(size.height()) * scale).ceil();
        let possible = scale > 0.0 && wide * high <= MOST_PIXELS;
        let pixels = possible.then(|| tiny_skia::Pixmap::new(wide as u32, high as u32));
        let mut pixels = pixels.flatten().ok_or_else(|| {
            let expected = format!("more than 0 and at most {MOST_PIXELS:e} pixels in all");
            BadInput::new("plot", "scale", expected, scale.to_string())
        })?;
        let transform = tiny_skia::Transform::from_scale(scale as f32, scale as f32);
        resvg::render(&tree, transform, &mut pixels.as_mut());
        pixels
            .encode_png()
            .map_err(|error| Error::Numerical(format!("can't encode the PNG: {error}")))
    }
}

/// The picture as resvg sees it, with our fonts and no others.
pub(super) fn parse(svg: &str) -> Result<usvg::Tree> {
    static FONTS: OnceLock<Arc<usvg::fontdb::Database>> = OnceLock::new();
    let fonts = FONTS.get_or_init(|| {
        let mut fonts = usvg::fontdb::Database::new();
        fonts.load_font_data(REGULAR.to_vec());
        fonts.load_font_data(BOLD.to_vec());
        Arc::new(fonts)
    });
    let options = usvg::Options {
        fontdb: Arc::clone(fonts),
        font_family: "DejaVu Sans".to_owned(),
        ..usvg::Options::default()
    };
    usvg::Tree::from_str(svg, &options)
        .map_err(|error| Error::Numerical(format!("the picture is no valid SVG: {error}")))
}
