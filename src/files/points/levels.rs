//! Parquet's levels for lists of one length.
//!
//! A repetition level is 0 at the first value of a row and 1 at the others; a definition level is the
//! highest one where a value is there. Both are stored as runs (a varint of twice the length, then the
//! level), or as packed bits (a varint of twice the number of bytes a bit, plus one). With rows of
//! one length and nothing missing the levels are known beforehand: they are written as runs, and
//! reading them is to check them.

/// Appends a run of `length` equal levels.
fn push_run(bytes: &mut Vec<u8>, length: u64, level: u8) {
    push_varint(bytes, length << 1);
    bytes.push(level);
}

/// Appends an unsigned number, seven bits a byte, the lowest first.
pub(super) fn push_varint(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// The levels of a page of `rows` rows of `width` values, both with their lengths, as a data page starts.
pub(super) fn page_levels(rows: usize, width: usize) -> Vec<u8> {
    let mut repetition = Vec::new();
    if width == 1 {
        push_run(&mut repetition, rows as u64, 0);
    } else {
        for _ in 0..rows {
            push_run(&mut repetition, 1, 0);
            push_run(&mut repetition, width as u64 - 1, 1);
        }
    }
    let mut definition = Vec::new();
    push_run(&mut definition, (rows * width) as u64, 1);
    let mut levels = Vec::new();
    for part in [repetition, definition] {
        levels.extend((part.len() as u32).to_le_bytes());
        levels.extend(part);
    }
    levels
}

/// Why levels are not those of rows of one length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Uneven {
    /// This row has so many values.
    Short { row: u64, length: u64 },
    /// This row has more values than the first.
    Long { row: u64 },
    /// In this row something is null or empty.
    Missing { row: u64 },
    /// The bytes are no levels.
    Malformed,
}

/// Equal levels that follow each other.
struct Run {
    length: u64,
    level: u8,
}

/// Goes through the runs of `count` levels of `bits` bits each.
fn for_each_run(
    mut bytes: &[u8],
    bits: u32,
    mut count: u64,
    mut visit: impl FnMut(Run) -> Result<(), Uneven>,
) -> Result<(), Uneven> {
    while count > 0 {
        let header = take_varint(&mut bytes).ok_or(Uneven::Malformed)?;
        if header & 1 == 0 {
            let (level, rest) = bytes.split_first().ok_or(Uneven::Malformed)?;
            bytes = rest;
            let length = (header >> 1).min(count);
            visit(Run {
                length,
                level: *level,
            })?;
            count -= length;
            if header < 2 {
                return Err(Uneven::Malformed);
            }
            continue;
        }
        let packed =
            usize::try_from((header >> 1) * u64::from(bits)).map_err(|_| Uneven::Malformed)?;
        // A last group may be cut off where its levels end.
        let (group, rest) = bytes.split_at(packed.min(bytes.len()));
        bytes = rest;
        let length = ((header >> 1) * 8).min(count);
        if (group.len() as u64) * 8 < length * u64::from(bits) {
            return Err(Uneven::Malformed);
        }
        for_each_packed(group, bits, length, &mut visit)?;
        count -= length;
    }
    Ok(())
}

fn for_each_packed(
    group: &[u8],
    bits: u32,
    length: u64,
    visit: &mut impl FnMut(Run) -> Result<(), Uneven>,
) -> Result<(), Uneven> {
    // Neighbours are joined, so that the visitor is called once a row or so.
    let mut run = Run {
        length: 0,
        level: 0,
    };
    for index in 0..length {
        let bit = index * u64::from(bits);
        let byte = (bit / 8) as usize;
        let pair = u16::from(group[byte]) | u16::from(*group.get(byte + 1).unwrap_or(&0)) << 8;
        let level = (pair >> (bit % 8)) as u8 & ((1 << bits) - 1);
        if run.length > 0 && level != run.level {
            visit(run)?;
            run = Run { length: 0, level };
        }
        run.level = level;
        run.length += 1;
    }
    visit(run)
}

fn take_varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let (byte, rest) = bytes.split_first()?;
        *bytes = rest;
        number |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(number);
        }
    }
    None
}

/// Checks the repetition levels of `count` values that follow `before` values of rows of `width`.
pub(super) fn check_repetition(
    bytes: &[u8],
    before: u64,
    count: u64,
    width: u64,
) -> Result<(), Uneven> {
    let mut at = before;
    for_each_run(bytes, 1, count, |run| {
        let (row, inside) = (at / width, at % width);
        match run.level {
            0 if inside != 0 => {
                return Err(Uneven::Short {
                    row,
                    length: inside,
                });
            }
            0 if run.length > 1 && width > 1 => return Err(Uneven::Short { row, length: 1 }),
            0 => {}
            _ if inside == 0 => {
                return Err(Uneven::Long {
                    row: row.saturating_sub(1),
                });
            }
            _ if inside + run.length > width => return Err(Uneven::Long { row }),
            _ => {}
        }
        at += run.length;
        Ok(())
    })
}

/// Checks that the definition levels of `count` values that follow `before` values are all `highest`.
pub(super) fn check_definition(
    bytes: &[u8],
    highest: u8,
    before: u64,
    count: u64,
    width: u64,
) -> Result<(), Uneven> {
    let bits = u8::BITS - highest.leading_zeros();
    let mut at = before;
    for_each_run(bytes, bits, count, |run| {
        if run.level != highest {
            return Err(Uneven::Missing { row: at / width });
        }
        at += run.length;
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Packs levels of `bits` bits.
    fn packed(levels: &[u8], bits: usize) -> Vec<u8> {
        let groups = levels.len().div_ceil(8);
        let mut bytes = Vec::new();
        push_varint(&mut bytes, (groups << 1 | 1) as u64);
        let start = bytes.len();
        bytes.resize(start + groups * bits, 0);
        for (index, level) in levels.iter().enumerate() {
            for bit in 0..bits {
                let at = index * bits + bit;
                bytes[start + at / 8] |= (level >> bit & 1) << (at % 8);
            }
        }
        bytes
    }

    fn repetition(rows: &[usize]) -> Vec<u8> {
        let row = |&length: &usize| (0..length).map(|i| u8::from(i > 0)).collect::<Vec<_>>();
        rows.iter().flat_map(row).collect()
    }

    #[test]
    fn our_own_levels_are_right() {
        for (rows, width) in [(1, 1), (5, 1), (1, 7), (300, 201), (3, 2)] {
            let levels = page_levels(rows, width);
            let length = u32::from_le_bytes(levels[..4].try_into().unwrap()) as usize;
            let count = (rows * width) as u64;
            assert_eq!(
                check_repetition(&levels[4..4 + length], 0, count, width as u64),
                Ok(())
            );
            let definition = &levels[8 + length..];
            assert_eq!(
                check_definition(definition, 1, 0, count, width as u64),
                Ok(())
            );
        }
    }

    #[test]
    fn packed_levels_are_read_across_pages() {
        let levels = repetition(&[5; 40]);
        for cut in [0, 1, 5, 13, 100] {
            let (first, second) = levels.split_at(cut);
            assert_eq!(
                check_repetition(&packed(first, 1), 0, cut as u64, 5),
                Ok(())
            );
            let rest = second.len() as u64;
            assert_eq!(
                check_repetition(&packed(second, 1), cut as u64, rest, 5),
                Ok(())
            );
        }
        let full = [3; 19];
        assert_eq!(check_definition(&packed(&full, 2), 3, 0, 19, 5), Ok(()));
    }

    #[test]
    fn uneven_rows_are_named() {
        let check = |rows: &[usize]| {
            let levels = repetition(rows);
            check_repetition(&packed(&levels, 1), 0, levels.len() as u64, 5)
        };
        assert_eq!(
            check(&[5, 5, 3, 5]),
            Err(Uneven::Short { row: 2, length: 3 })
        );
        assert_eq!(check(&[5, 6, 5]), Err(Uneven::Long { row: 1 }));
        assert_eq!(
            check(&[5, 1, 1, 5]),
            Err(Uneven::Short { row: 1, length: 1 })
        );
        let mut definition = vec![3; 20];
        definition[13] = 2;
        assert_eq!(
            check_definition(&packed(&definition, 2), 3, 0, 20, 5),
            Err(Uneven::Missing { row: 2 })
        );
        assert_eq!(check_repetition(&[], 0, 1, 5), Err(Uneven::Malformed));
        assert_eq!(check_repetition(&[0, 0], 0, 1, 5), Err(Uneven::Malformed));
    }
}
