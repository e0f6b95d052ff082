//! Numbers as they lie in files: little-endian, not aligned, in the bulk.

/// Copies 8-byte numbers into `values` (as many) and tells whether all of them are finite.
pub(crate) fn copy_f64(bytes: &[u8], values: &mut [f64]) -> bool {
    for (value, bytes) in values.iter_mut().zip(bytes.as_chunks::<8>().0) {
        *value = f64::from_le_bytes(*bytes);
    }
    all_finite(values)
}

/// Copies 4-byte numbers into `values` (as many) and tells whether all of them are finite.
pub(crate) fn copy_f32(bytes: &[u8], values: &mut [f64]) -> bool {
    for (value, bytes) in values.iter_mut().zip(bytes.as_chunks::<4>().0) {
        *value = f64::from(f32::from_le_bytes(*bytes));
    }
    all_finite(values)
}

/// Are all values finite?
pub(crate) fn all_finite(values: &[f64]) -> bool {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    const LOWEST: u64 = 0x0010_0000_0000_0000;
    // An exponent of all ones, and only that, carries into the sign when one is added to it:
    // two cheap instructions a value, on any machine's vectors.
    let carried = values.iter().fold(0, |carried, value| {
        carried | ((value.to_bits() & EXPONENT) + LOWEST)
    });
    carried >> 63 == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_finite_is_found_anywhere() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -f64::NAN] {
            for at in 0..9 {
                let mut values = [
                    f64::MAX,
                    f64::MIN,
                    0.0,
                    -0.0,
                    5e-324,
                    1.0,
                    -1.0,
                    2.0,
                    1e-300,
                ];
                assert!(all_finite(&values));
                values[at] = bad;
                let mut read = [0.0; 9];
                assert!(!copy_f64(bytemuck::cast_slice(&values), &mut read));
                assert_eq!(values.map(f64::to_bits), read.map(f64::to_bits));
                let mut singles = [f32::MAX, f32::MIN, 0.0, -0.0, 1e-45, 1.0, -1.0, 2.0, 1e-30];
                assert!(copy_f32(bytemuck::cast_slice(&singles), &mut read));
                assert_eq!(singles.map(f64::from), read);
                singles[at] = bad as f32;
                assert!(!copy_f32(bytemuck::cast_slice(&singles), &mut read));
            }
        }
    }
}
