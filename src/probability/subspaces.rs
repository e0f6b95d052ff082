//! Which variables share a two-dimensional subspace.

use std::ops::Range;

/// The subspaces of variables in order: pairs of the leading `parameters`, an odd last one of them alone,
/// then pairs of the rest, in which a wavenumber has two; an odd last one alone.
pub(super) fn subspaces(
    dimensions: usize,
    parameters: usize,
) -> impl Iterator<Item = Range<usize>> {
    let pairs = |variables: Range<usize>| {
        let end = variables.end;
        variables
            .step_by(2)
            .map(move |first| first..(first + 2).min(end))
    };
    let parameters = parameters.min(dimensions);
    pairs(0..parameters).chain(pairs(parameters..dimensions))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_subspace_holds_a_parameter_and_an_amplitude() {
        let widths = |d, p| -> Vec<usize> { subspaces(d, p).map(|s| s.len()).collect() };
        assert_eq!(widths(6, 0), [2, 2, 2]);
        assert_eq!(widths(7, 0), [2, 2, 2, 1]);
        assert_eq!(widths(7, 3), [2, 1, 2, 2]);
        assert_eq!(widths(6, 2), [2, 2, 2]);
        assert_eq!(widths(1, 1), [1]);
        assert_eq!(widths(0, 0), [0; 0]);
        for (d, p) in [(7, 3), (8, 5), (9, 0)] {
            let all: Vec<usize> = subspaces(d, p).flatten().collect();
            assert_eq!(all, (0..d).collect::<Vec<_>>());
        }
    }
}
