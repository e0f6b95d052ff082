//! How points are grouped into bands and blocks.

/// What the values of a band may take in memory, bytes. Two bands are there at a time: one is written while the next
/// is stepped.
const BAND_BYTES: usize = 96 << 20;

/// What the irregularities of a block may take in memory, bytes. Two are there at a time, too.
const BLOCK_BYTES: usize = 32 << 20;

/// The largest number of points in a message.
const LARGEST_BLOCK: usize = 4096;

/// Points of a band and of a block: `(points_per_band, block)`.
///
/// A band holds as many points as fit in 96 MiB with `times * quantities` doubles each; a block is the largest power
/// of two, at most 4096, that fits, and of which `positions` doubles of irregularity each fit in 32 MiB; a band is a
/// whole number of blocks. Nothing else enters, threads and machine least of all: the file's bytes must not depend on
/// them.
pub fn band_layout(times: usize, quantities: usize, positions: usize) -> (usize, usize) {
    let fitting = |bytes: usize, values: usize| {
        let point_bytes = values.saturating_mul(size_of::<f64>()).max(1);
        (bytes / point_bytes).max(1)
    };
    let band = fitting(BAND_BYTES, times.saturating_mul(quantities));
    let block = fitting(BLOCK_BYTES, positions).min(band);
    let block = LARGEST_BLOCK.min(1 << block.ilog2());
    (band - band % block, block)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_fits_and_no_further_block_would() {
        for times in [1, 2, 201, 3901, 1_000_000] {
            for quantities in [1, 7, 40] {
                for positions in [0, 401, 10_000, 1_000_000] {
                    let (band, block) = band_layout(times, quantities, positions);
                    let size = |points: usize| points * times * quantities * 8;
                    let excitation = |points: usize| points * positions * 8;
                    assert!(block.is_power_of_two() && block <= 4096 && band % block == 0);
                    assert!(size(band) <= BAND_BYTES || band == 1);
                    assert!(size(band + block) > BAND_BYTES);
                    assert!(excitation(block) <= BLOCK_BYTES);
                    let larger =
                        size(2 * block) > BAND_BYTES || excitation(2 * block) > BLOCK_BYTES;
                    assert!(block == 4096 || larger);
                }
            }
        }
    }
}
