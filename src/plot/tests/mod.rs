//! Every figure, drawn from made-up but realistic data: well-formed, inside its page, without texts
//! over each other, the same twice, and small.

use resvg::{tiny_skia, usvg};

use super::image::parse;
use super::*;

mod errors;
mod made;
use made::{Made, failure_image, gallery, heat_map_image, page, slices_image};

/// The boxes of all texts of a picture, in pixels.
fn texts(group: &usvg::Group, found: &mut Vec<(String, tiny_skia::Rect)>) {
    for node in group.children() {
        match node {
            usvg::Node::Group(group) => texts(group, found),
            usvg::Node::Text(text) => {
                let words = text.chunks().iter().map(|chunk| chunk.text()).collect();
                found.push((words, text.abs_bounding_box()));
            }
            usvg::Node::Path(_) | usvg::Node::Image(_) => {}
        }
    }
}

#[test]
fn every_picture_is_well_formed_small_and_inside_its_page() {
    for (name, image) in gallery() {
        assert!(
            image.svg.len() < 3_000_000,
            "{name}: {} bytes",
            image.svg.len()
        );
        // A path can't hold them; base64 can.
        assert!(!image.svg.contains(r#"d="MNaN"#), "{name}");
        let tree = parse(&image.svg).unwrap();
        let mut found = Vec::new();
        texts(tree.root(), &mut found);
        assert!(found.len() > 10, "{name}");
        for (text, area) in &found {
            let inside = area.left() >= 0.0 && area.top() >= 0.0;
            let inside = inside && area.right() <= 1000.0 && area.bottom() <= 650.0;
            assert!(inside, "{name}: {text} at {area:?}");
        }
        // A label along a slanted edge has a box much larger than itself.
        if name.starts_with("surface") {
            continue;
        }
        for (index, (text, area)) in found.iter().enumerate() {
            for (other, beside) in &found[..index] {
                assert!(
                    area.intersect(beside).is_none(),
                    "{name}: {text} over {other}"
                );
            }
        }
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let made = Made::deflection();
    let once = || heat_map_image(&made, ValueAxis::Automatic, DensityScale::SquareRoot);
    let (first, second) = (once(), once());
    assert_eq!(first, second);
    assert_eq!(first.to_png(0.5).unwrap(), second.to_png(0.5).unwrap());
}

#[test]
fn a_png_has_the_size_asked_for_and_the_colours_of_the_heat_map() {
    let made = Made::acceleration();
    let image = heat_map_image(&made, ValueAxis::Value, DensityScale::SquareRoot);
    for (scale, wide, high) in [(1.0, 1000, 650), (2.0, 2000, 1300), (0.5, 500, 325)] {
        let png = image.to_png(scale).unwrap();
        let pixels = tiny_skia::Pixmap::decode_png(&png).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (wide, high));
    }
    // Most of a heat map is where nothing ever is: the darkest colour must be the most common but
    // the white of the page, which it is only where the embedded image was decoded.
    let png = image.to_png(1.0).unwrap();
    let pixels = tiny_skia::Pixmap::decode_png(&png).unwrap();
    let dark = colour::viridis(0.0);
    let of = |c: &&tiny_skia::PremultipliedColorU8| {
        (c.red(), c.green(), c.blue()) == (dark.0, dark.1, dark.2)
    };
    assert!(pixels.pixels().iter().filter(of).count() > 10_000);
}

#[test]
fn a_scale_without_sense_is_refused() {
    let image = failure_image(0.4);
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e6] {
        let message = image.to_png(scale).unwrap_err().to_string();
        let expected = "plot: scale: expected more than 0 and at most 1e8 pixels in all, found ";
        assert_eq!(message, format!("{expected}{scale}"));
    }
}

#[test]
fn long_and_strange_titles_stay_inside() {
    let made = Made::acceleration();
    let title = "A <case> & its \"title\" \u{7} that goes on, and on, and on, and on, and on, and on, and on, and on";
    let page = Page::new(title, "x".repeat(300));
    let figure = Slices {
        label: made.label,
        densities: &made.densities(),
        times: &[1.0],
        reference: None,
        value_axis: ValueAxis::Automatic,
    };
    let image = figure.draw(&page).unwrap();
    let mut found = Vec::new();
    texts(parse(&image.svg).unwrap().root(), &mut found);
    assert!(found.iter().all(|(_, area)| area.right() <= 1000.0));
}

#[test]
fn thinned_lines_are_said() {
    let made = Made::deflection();
    let (statistics, responses) = (made.statistics(), made.responses());
    let responses: Vec<&[f64]> = responses.iter().take(100).map(Vec::as_slice).collect();
    let figure = Fan {
        label: made.label,
        times: &made.times,
        responses: &responses,
        point_count: 100_000,
        statistics: &statistics,
        value_axis: ValueAxis::Automatic,
    };
    let svg = figure.draw(&page("Responses")).unwrap().svg;
    assert!(svg.contains("100 of 100000 responses drawn"));
}

#[test]
fn the_nearest_time_is_drawn_once_and_said() {
    let made = Made::acceleration();
    let svg = slices_image(&made, &[0.803, 0.798, 1.4], None).svg;
    assert_eq!(svg.matches("t = 0.8 s").count(), 1);
    assert_eq!(svg.matches("t = 1.4 s").count(), 1);
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let made = Made::acceleration();
    let densities = made.densities();
    let figure = HeatMap {
        label: made.label,
        densities: &densities[..1],
        statistics: None,
        value_axis: ValueAxis::Automatic,
        density_scale: DensityScale::SquareRoot,
    };
    let message = figure.draw(&page("")).unwrap_err().to_string();
    assert_eq!(
        message,
        "heat map of the density: times: expected at least 2, found 1"
    );
    let error = Fan {
        label: made.label,
        times: &made.times,
        responses: &[&[0.0, 1.0]],
        point_count: 1,
        statistics: &made.statistics(),
        value_axis: ValueAxis::Automatic,
    };
    let message = error.draw(&page("")).unwrap_err().to_string();
    assert_eq!(
        message,
        "plot of the responses: times of a response: expected 201, found 2"
    );
}

#[test]
fn the_smallest_page_has_room_for_a_plot() {
    let made = Made::deflection();
    let page = Page {
        width: 0.0,
        height: 0.0,
        ..page("Density")
    };
    let figure = HeatMap {
        label: made.label,
        densities: &made.densities(),
        statistics: None,
        value_axis: ValueAxis::Automatic,
        density_scale: DensityScale::SquareRoot,
    };
    let size = parse(&figure.draw(&page).unwrap().svg).unwrap().size();
    assert_eq!((size.width(), size.height()), (400.0, 300.0));
}
