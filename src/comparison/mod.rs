//! How far two probability densities lie apart.
//!
//! A density is given by a table: nodes y, density p and cumulative probability F at each. With F and G at
//! common nodes, ΔF and ΔG the probabilities of the cells between them,
//!
//! | measure | is | from the tables |
//! |---|---|---|
//! | L1 distance | ∫ \|p − q\| dy | Σ \|ΔF − ΔG\| |
//! | total variation | largest difference of the probabilities of any event | half the L1 distance |
//! | Kolmogorov-Smirnov | max \|F − G\| | at the nodes |
//! | Wasserstein-1 | ∫ \|F − G\| dy | straight lines between the nodes |
//! | Hellinger | √(½ ∫ (√p − √q)² dy) | √(½ Σ (√ΔF − √ΔG)²) |
//!
//! Everything is taken from the cumulative probabilities: a density with edges or poles can't be judged by
//! straight lines between its nodes, while F at a node is right whatever lies between. The common nodes
//! ([`common_nodes`]) are those of the table that is coarser there, so that F is interpolated in the finer
//! table only. Sums over cells never exceed the integrals; densities that cross inside a cell of width Δ
//! lose Δ² |p′ − q′| / 4 at most of the L1 distance.
//!
//! Source of the definitions: A. L. Gibbs, F. E. Su, On choosing and bounding probability metrics,
//! Int. Stat. Rev. 70 (2002) 419-435.

mod distances;
mod tabulated;

pub use distances::{Distances, common_nodes, distances};
pub use tabulated::{BadTable, Tabulated};

#[cfg(test)]
mod tests;
