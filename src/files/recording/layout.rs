//! How points are grouped into bands and blocks.

/// What the values of a band may take, bytes.
const BAND_BYTES: usize = 128 << 20;

/// The largest number of points in a message.
const LARGEST_BLOCK: usize = 4096;

/// Points of a band and of a block: `(points_per_band, block)`.
///
/// A band holds as many points as fit in 128 MiB with `times * quantities` values of `bytes_per_value`
/// bytes each; a block is the largest power of two, at most 4096, that fits; a band is a whole number
/// of blocks. Nothing else enters, threads and machine least of all: the file's bytes must not depend on them.
pub fn band_layout(times: usize, quantities: usize, bytes_per_value: usize) -> (usize, usize) {
    let point_bytes = times
        .saturating_mul(quantities)
        .saturating_mul(bytes_per_value)
        .max(1);
    let fitting = (BAND_BYTES / point_bytes).max(1);
    let block = LARGEST_BLOCK.min(1 << fitting.ilog2());
    (fitting - fitting % block, block)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_fits_and_no_further_block_would() {
        for times in [1, 2, 201, 3901, 1_000_000] {
            for quantities in [1, 7, 40] {
                for bytes in [4, 8] {
                    let (band, block) = band_layout(times, quantities, bytes);
                    let size = |points: usize| points * times * quantities * bytes;
                    assert!(block.is_power_of_two() && block <= 4096 && band % block == 0);
                    assert!(size(band) <= BAND_BYTES || band == 1);
                    assert!(size(band + block) > BAND_BYTES);
                    assert!(block == 4096 || size(2 * block) > BAND_BYTES);
                }
            }
        }
    }
}
