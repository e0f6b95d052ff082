//! Sparse symmetric matrices in the order of their rows, and their factors A = L D Lᵀ.
//!
//! The pattern is found once; numbers are filled in for every set of parameters.

use std::ops::Range;

/// Rows of (column, place of the value).
#[derive(Debug, Clone, Default)]
pub struct Rows {
    pub starts: Vec<u32>,
    pub columns: Vec<u32>,
}

impl Rows {
    fn of(rows: &[Vec<u32>]) -> Rows {
        let mut starts = vec![0];
        let mut columns = Vec::new();
        for row in rows {
            columns.extend_from_slice(row);
            starts.push(columns.len() as u32);
        }
        Rows { starts, columns }
    }

    /// The places of a row's entries.
    pub fn range(&self, row: usize) -> std::ops::Range<usize> {
        self.starts[row] as usize..self.starts[row + 1] as usize
    }
}

/// What all matrices of one shape share.
#[derive(Debug, Clone)]
pub struct Pattern {
    pub size: usize,
    /// The lower triangle with its diagonal, columns ascending: the diagonal is a row's last entry.
    lower: Rows,
    /// Of each collected piece, its place in the lower triangle.
    slots: Vec<u32>,
    /// L below its diagonal by rows; and by columns, with places among the rows' entries.
    pub factor: Rows,
    pub factor_columns: Rows,
    column_slots: Vec<u32>,
    /// Whole rows of K, and of M where it is not empty, with places in the lower triangle.
    pub stiffness: Rows,
    stiffness_slots: Vec<u32>,
    pub mass: Rows,
    mass_slots: Vec<u32>,
}

/// What is lost in rounding.
const LOST: f64 = 1e-16;

/// M, C and K in the lower triangle of a pattern.
#[derive(Debug, Clone)]
pub struct Lower {
    pub mass: Vec<f64>,
    pub damping: Vec<f64>,
    pub stiffness: Vec<f64>,
}

/// L by rows and 1/D.
#[derive(Debug, Clone)]
pub struct Factor {
    pub lower: Vec<f64>,
    pub inverse: Vec<f64>,
}

impl Pattern {
    /// `places` (row, column ≤ row) of the pieces; `massive` says which of them have mass.
    pub fn new(size: usize, places: &[(u32, u32)], massive: impl Fn(usize) -> bool) -> Pattern {
        let mut rows: Vec<Vec<u32>> = (0..size as u32).map(|row| vec![row]).collect();
        let mut massive_rows: Vec<Vec<u32>> = vec![Vec::new(); size];
        for (piece, (row, column)) in places.iter().enumerate() {
            rows[*row as usize].push(*column);
            if massive(piece) {
                massive_rows[*row as usize].push(*column);
                massive_rows[*column as usize].push(*row);
            }
        }
        for row in rows.iter_mut().chain(&mut massive_rows) {
            row.sort_unstable();
            row.dedup();
        }
        let lower = Rows::of(&rows);
        let slot = |row: u32, column: u32| {
            let (row, column) = (row.max(column), row.min(column));
            let range = lower.range(row as usize);
            let found = lower.columns[range.clone()].binary_search(&column);
            (range.start + found.expect("an entry of the pattern")) as u32
        };
        let slots = places.iter().map(|(row, column)| slot(*row, *column));
        let slots = slots.collect();
        let mut whole = rows.clone();
        for (row, columns) in rows.iter().enumerate() {
            for column in &columns[..columns.len() - 1] {
                whole[*column as usize].push(row as u32);
            }
        }
        let of_rows = |rows: &[Vec<u32>]| -> Vec<u32> {
            let all = rows.iter().enumerate();
            all.flat_map(|(row, columns)| columns.iter().map(move |c| (row as u32, *c)))
                .map(|(row, column)| slot(row, column))
                .collect()
        };
        let mut pattern = Pattern {
            size,
            stiffness: Rows::of(&whole),
            stiffness_slots: of_rows(&whole),
            mass: Rows::of(&massive_rows),
            mass_slots: of_rows(&massive_rows),
            factor: Rows::default(),
            factor_columns: Rows::default(),
            column_slots: Vec::new(),
            lower,
            slots,
        };
        pattern.set_factor(&fill(&rows));
        pattern
    }

    /// Sets the columns of each row of L below its diagonal.
    fn set_factor(&mut self, rows: &[Vec<u32>]) {
        let factor = Rows::of(rows);
        let mut columns: Vec<Vec<u32>> = vec![Vec::new(); self.size];
        let mut slots: Vec<Vec<u32>> = vec![Vec::new(); self.size];
        for row in 0..self.size {
            for place in factor.range(row) {
                let column = factor.columns[place] as usize;
                columns[column].push(row as u32);
                slots[column].push(place as u32);
            }
        }
        self.factor = factor;
        self.factor_columns = Rows::of(&columns);
        self.column_slots = slots.concat();
    }

    /// Leaves out of `rows` what is lost in rounding at the end of the columns before those rows: what couples them
    /// has died out there. Of a factor of a matrix of this pattern.
    pub fn prune(&mut self, factor: &Factor, rows: Range<usize>) {
        let mut kept: Vec<Vec<u32>> = (0..self.size)
            .map(|row| self.factor.columns[self.factor.range(row)].to_vec())
            .collect();
        for row in rows.clone() {
            let first = self.factor.range(row).start;
            let columns = &mut kept[row];
            let before = columns.partition_point(|column| (*column as usize) < rows.start);
            // An entry of the Cholesky factor beside the root of its row's diagonal.
            let counts = |k: &usize| {
                let scale = factor.inverse[row] / factor.inverse[columns[*k] as usize];
                factor.lower[first + k].powi(2) * scale > LOST * LOST
            };
            let end = (0..before).rev().find(counts).map_or(0, |last| last + 1);
            columns.drain(end..before);
        }
        self.set_factor(&kept);
    }

    /// Sums the pieces.
    pub fn collect(&self, values: &[[f64; 3]]) -> Lower {
        let mut lower = Lower {
            mass: vec![0.0; self.lower.columns.len()],
            damping: vec![0.0; self.lower.columns.len()],
            stiffness: vec![0.0; self.lower.columns.len()],
        };
        for (slot, [m, c, k]) in self.slots.iter().zip(values) {
            let slot = *slot as usize;
            lower.mass[slot] += m;
            lower.damping[slot] += c;
            lower.stiffness[slot] += k;
        }
        lower
    }

    /// The factor of a matrix given by its lower triangle; none where it is not positive definite.
    pub fn factorise(&self, lower: &[f64]) -> Option<Factor> {
        let mut factor = Factor {
            lower: vec![0.0; self.factor.columns.len()],
            inverse: vec![0.0; self.size],
        };
        let mut scaled = vec![0.0; self.size];
        for row in 0..self.size {
            self.factorise_row(lower, row, 0, &mut factor, &mut scaled)?;
        }
        Some(factor)
    }

    /// The factor of the principal block that begins at row `from`, as far as it differs from the whole factor: the end of
    /// those rows. `work` is the whole factor and is left as it was but for these rows.
    pub fn factorise_from(
        &self,
        lower: &[f64],
        from: usize,
        end: usize,
        work: &mut Factor,
        scaled: &mut [f64],
    ) -> usize {
        let mut same = 0;
        for row in from..end {
            let range = self.factor.range(row);
            let before: Vec<f64> = work.lower[range.clone()].to_vec();
            let inverse = work.inverse[row];
            self.factorise_row(lower, row, from, work, scaled)
                .expect("a principal block of a positive definite matrix");
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-13 * b.abs().max(1e-3);
            let pairs = before.iter().zip(&work.lower[range]);
            let unchanged = (work.inverse[row] / inverse - 1.0).abs() <= 1e-13;
            same = match unchanged && pairs.into_iter().all(|(a, b)| close(*b, *a)) {
                true => same + 1,
                false => 0,
            };
            if same == 16 {
                return row + 1;
            }
        }
        end
    }

    /// A row of the factor of the principal block from row `from` on; `scaled`, zero before and after, takes yⱼ = Lᵢⱼ Dⱼ.
    fn factorise_row(
        &self,
        lower: &[f64],
        row: usize,
        from: usize,
        factor: &mut Factor,
        scaled: &mut [f64],
    ) -> Option<()> {
        for place in self.lower.range(row) {
            scaled[self.lower.columns[place] as usize] = lower[place];
        }
        let mut pivot = scaled[row];
        for place in self.factor.range(row) {
            let column = self.factor.columns[place] as usize;
            if column < from {
                scaled[column] = 0.0;
                factor.lower[place] = 0.0;
                continue;
            }
            let inner: f64 = self
                .factor
                .range(column)
                .map(|k| factor.lower[k] * scaled[self.factor.columns[k] as usize])
                .sum();
            scaled[column] -= inner;
            let l = scaled[column] * factor.inverse[column];
            factor.lower[place] = l;
            pivot -= l * scaled[column];
        }
        scaled[row] = 0.0;
        for place in self.factor.range(row) {
            scaled[self.factor.columns[place] as usize] = 0.0;
        }
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        factor.inverse[row] = 1.0 / pivot;
        Some(())
    }

    /// A⁻¹ b in place of b.
    pub fn solve(&self, factor: &Factor, b: &mut [f64]) {
        for row in 0..self.size {
            let known: f64 = self
                .factor
                .range(row)
                .map(|k| factor.lower[k] * b[self.factor.columns[k] as usize])
                .sum();
            b[row] -= known;
        }
        for row in (0..self.size).rev() {
            b[row] *= factor.inverse[row];
            let known: f64 = self
                .factor_columns
                .range(row)
                .map(|k| {
                    let place = self.column_slots[k] as usize;
                    factor.lower[place] * b[self.factor_columns.columns[k] as usize]
                })
                .sum();
            b[row] -= known;
        }
    }

    /// Values of whole rows of the stiffness from the lower triangle.
    pub fn whole_stiffness<'a>(&'a self, lower: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.stiffness_slots
            .iter()
            .map(|slot| lower[*slot as usize])
    }

    /// Values of whole rows of the mass.
    pub fn whole_mass<'a>(&'a self, lower: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        self.mass_slots.iter().map(|slot| lower[*slot as usize])
    }

    /// Values of L by columns, of these columns.
    pub fn by_columns<'a>(
        &'a self,
        factor: &'a Factor,
        columns: Range<usize>,
    ) -> impl Iterator<Item = f64> + 'a {
        let starts = &self.factor_columns.starts;
        let places = starts[columns.start] as usize..starts[columns.end] as usize;
        self.column_slots[places]
            .iter()
            .map(|slot| factor.lower[*slot as usize])
    }

    /// The places of a row of the lower triangle, and their columns.
    pub fn lower_row(&self, row: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        let range = self.lower.range(row);
        range.map(|place| (place, self.lower.columns[place] as usize))
    }
}

/// The pattern of L below its diagonal, row by row: along the elimination tree.
fn fill(rows: &[Vec<u32>]) -> Vec<Vec<u32>> {
    const NONE: u32 = u32::MAX;
    let size = rows.len();
    let mut parent = vec![NONE; size];
    let mut seen = vec![NONE; size];
    let mut filled = Vec::with_capacity(size);
    for (row, columns) in rows.iter().enumerate() {
        let row = row as u32;
        seen[row as usize] = row;
        let mut reached = Vec::new();
        for column in &columns[..columns.len() - 1] {
            let mut at = *column;
            while seen[at as usize] != row {
                seen[at as usize] = row;
                reached.push(at);
                if parent[at as usize] == NONE {
                    parent[at as usize] = row;
                }
                at = parent[at as usize];
            }
        }
        reached.sort_unstable();
        filled.push(reached);
    }
    filled
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix with an arrow and a band, against its product with a known solution.
    #[test]
    fn solves_what_it_factors() {
        let size = 12;
        let mut places = Vec::new();
        let mut values = Vec::new();
        for row in 0..size {
            for column in 0..=row {
                if row - column <= 2 || row == size - 1 && column % 3 == 0 {
                    places.push((row as u32, column as u32));
                    let value = if row == column {
                        9.0
                    } else {
                        1.0 / (1 + row + column) as f64
                    };
                    values.push([0.0, 0.0, value]);
                }
            }
        }
        // A piece twice.
        places.push((5, 4));
        values.push([0.0, 0.0, 0.25]);
        let pattern = Pattern::new(size, &places, |_| false);
        let lower = pattern.collect(&values).stiffness;
        let factor = pattern.factorise(&lower).unwrap();
        let solution: Vec<f64> = (0..size).map(|k| (k as f64 + 0.5).sin()).collect();
        let whole: Vec<f64> = pattern.whole_stiffness(&lower).collect();
        let mut b: Vec<f64> = (0..size)
            .map(|row| {
                let range = pattern.stiffness.range(row);
                range
                    .map(|k| whole[k] * solution[pattern.stiffness.columns[k] as usize])
                    .sum()
            })
            .collect();
        pattern.solve(&factor, &mut b);
        for (found, expected) in b.iter().zip(&solution) {
            assert!((found - expected).abs() < 1e-14 * size as f64);
        }
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        let pattern = Pattern::new(2, &[(0, 0), (1, 0), (1, 1)], |_| false);
        assert!(pattern.factorise(&[1.0, 2.0, 1.0]).is_none());
    }
}
