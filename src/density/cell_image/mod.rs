//! The image of each point's own cell.
//!
//! With one or a few random variables the response is a smooth function of them, and the points show its
//! shape: a quadratic through a point and its neighbours. The probability of a cell about
//! the point is then not spread by a kernel, but as that quadratic maps it; the density needs no width
//! and keeps its edges.
//!
//! * One variable ([`CellLine`]): the points in ascending order, cells split midway between them in
//!   u = Φ(x). The share of a cell below y follows from the roots of A + Bδ + Cδ² = y, so that the
//!   distribution function is exact for the piecewise quadratic. As positive Gaussians: width
//!   0.6 max(|Δg|, |Δ²g|/2), Δg and Δ²g across the cell.
//! * A few ([`CellSpace`]): a weighted quadratic through each point on its neighbours. The space in parts, the
//!   finer the more probable, each belonging to the nearest point: the image of a part is the sum of two
//!   tilted boxes, by the quadratic's value, slopes and bends at the part's mean.
//!
//! Both take the variables' scale ([`Scale`](super::known::Scale), u or x for each variable) on which the
//! quadratics foretell the responses of further neighbours best, at each time anew.
//!
//! A cell's probability is its own share of the space, not the point's assigned probability: where
//! the cells are known, the points are only where the response was looked at.
//!
//! The density on a node is the mean over half a distance to either side, a difference of the
//! distribution function; that is exact at every node.

mod cumulative;
mod line;
mod neighbours;
mod parts;
mod quadratics;
mod space;
mod trapezoids;

pub(super) use line::CellLine;
pub(super) use space::CellSpace;
