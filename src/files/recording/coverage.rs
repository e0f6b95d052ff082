//! Which points of a channel have been seen up to which time.
//!
//! A channel's points come in blocks; each block runs through the same times, in ascending order.
//! How the blocks of different points follow each other in the file is left to the writer.

use std::collections::HashMap;
use std::ops::Range;

/// How far two writers' times may differ and still be the same, s: the resolution of a log time.
const SAME_TIME: f64 = 1e-9;

/// Are two times the same?
pub(super) fn same_time(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME_TIME
}

/// Consecutive points that share their messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct BlockState {
    pub first: u32,
    pub length: u32,
    /// The index of the time that comes next.
    pub next: u32,
}

impl BlockState {
    pub fn points(&self) -> Range<u64> {
        u64::from(self.first)..u64::from(self.first) + u64::from(self.length)
    }
}

/// Why a message does not fit those before it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Misfit {
    /// The block had this many values before.
    Length { before: u32 },
    /// This time should come next.
    Time { expected: f64 },
    /// The times do not ascend.
    NotAscending { before: f64 },
    /// All times are there already.
    TooMany,
    /// The block was not there when the file was opened.
    NewBlock,
}

/// The blocks of a channel.
#[derive(Debug, Clone, Default)]
pub(super) struct Coverage {
    pub blocks: Vec<BlockState>,
    at: HashMap<u32, usize>,
    /// The block of the next message, if blocks come in the same order each time.
    guess: usize,
}

impl Coverage {
    /// Records a message and returns the index of its time.
    ///
    /// Unknown times and blocks are appended if `learn`; otherwise they are misfits.
    pub fn observe(
        &mut self,
        times: &mut Vec<f64>,
        learn: bool,
        time: f64,
        first: u32,
        length: u32,
    ) -> Result<usize, Misfit> {
        let index = self.find(first, length, learn)?;
        self.guess = (index + 1) % self.blocks.len();
        let block = &mut self.blocks[index];
        if block.length != length {
            return Err(Misfit::Length {
                before: block.length,
            });
        }
        let next = block.next as usize;
        match times.get(next) {
            Some(&expected) if same_time(expected, time) => {}
            Some(&expected) => return Err(Misfit::Time { expected }),
            None if !learn => return Err(Misfit::TooMany),
            None => {
                if let Some(&before) = times.last()
                    && (time <= before || same_time(time, before))
                {
                    return Err(Misfit::NotAscending { before });
                }
                times.push(time);
            }
        }
        block.next += 1;
        Ok(next)
    }

    fn find(&mut self, first: u32, length: u32, learn: bool) -> Result<usize, Misfit> {
        if let Some(block) = self.blocks.get(self.guess)
            && block.first == first
        {
            return Ok(self.guess);
        }
        if let Some(&index) = self.at.get(&first) {
            return Ok(index);
        }
        if !learn {
            return Err(Misfit::NewBlock);
        }
        self.at.insert(first, self.blocks.len());
        self.blocks.push(BlockState {
            first,
            length,
            next: 0,
        });
        Ok(self.blocks.len() - 1)
    }

    /// Forgets which times have been seen, for another pass over the same file.
    pub fn restart(&mut self) {
        self.guess = 0;
        self.blocks.iter_mut().for_each(|block| block.next = 0);
    }

    /// A block that has not reached the end of the times.
    pub fn unfinished(&self, times: usize) -> Option<BlockState> {
        self.blocks
            .iter()
            .find(|block| (block.next as usize) < times)
            .copied()
    }

    /// The points as ranges that do not touch, ascending; or two blocks that overlap.
    pub fn ranges(&self) -> Result<Vec<Range<u64>>, [Range<u64>; 2]> {
        let mut blocks: Vec<Range<u64>> = self.blocks.iter().map(BlockState::points).collect();
        blocks.sort_by_key(|points| points.start);
        merge(&blocks)
    }
}

/// Joins ascending ranges where they touch; fails with two that overlap.
pub(super) fn merge(sorted: &[Range<u64>]) -> Result<Vec<Range<u64>>, [Range<u64>; 2]> {
    let mut merged: Vec<Range<u64>> = Vec::new();
    for (index, range) in sorted.iter().enumerate() {
        match merged.last_mut() {
            Some(last) if range.start < last.end => {
                return Err([sorted[index - 1].clone(), range.clone()]);
            }
            Some(last) if range.start == last.end => last.end = range.end,
            Some(_) | None => merged.push(range.clone()),
        }
    }
    Ok(merged)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_order_of_blocks_and_bands_is_followed() {
        let mut times = Vec::new();
        let mut coverage = Coverage::default();
        // Two blocks in time order, then one block of another band.
        for (k, time) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            for first in [0, 4] {
                assert_eq!(coverage.observe(&mut times, true, time, first, 4), Ok(k));
            }
        }
        for (k, time) in [0.0, 0.5].into_iter().enumerate() {
            assert_eq!(coverage.observe(&mut times, true, time, 8, 2), Ok(k));
        }
        assert_eq!(
            coverage.unfinished(times.len()).map(|block| block.first),
            Some(8)
        );
        assert_eq!(coverage.observe(&mut times, true, 1.0, 8, 2), Ok(2));
        assert!(coverage.unfinished(times.len()).is_none());
        assert_eq!(coverage.ranges(), Ok(std::iter::once(0..10).collect()));
        coverage.restart();
        assert_eq!(coverage.observe(&mut times, false, 0.0, 4, 4), Ok(0));
    }

    #[test]
    fn misfits_are_told_apart() {
        let mut times = Vec::new();
        let mut coverage = Coverage::default();
        coverage.observe(&mut times, true, 0.0, 0, 4).unwrap();
        coverage.observe(&mut times, true, 1.0, 0, 4).unwrap();
        let mut observe =
            |learn, time, first, length| coverage.observe(&mut times, learn, time, first, length);
        assert_eq!(observe(true, 2.0, 0, 3), Err(Misfit::Length { before: 4 }));
        assert_eq!(
            observe(true, 1.0, 0, 4),
            Err(Misfit::NotAscending { before: 1.0 })
        );
        assert_eq!(observe(false, 2.0, 0, 4), Err(Misfit::TooMany));
        assert_eq!(observe(false, 0.0, 9, 4), Err(Misfit::NewBlock));
        assert_eq!(
            observe(true, 1.0, 2, 4),
            Err(Misfit::Time { expected: 0.0 })
        );
        assert_eq!(coverage.ranges(), Err([0..4, 2..6]));
    }
}
