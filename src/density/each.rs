//! The same work on each of many.

use rayon::prelude::*;

/// Whether there is one thread: work is then done on the caller's own, whose cache holds the data.
pub(super) fn alone() -> bool {
    rayon::current_num_threads() == 1
}

/// What `work` makes of each of the items with its index, in their order.
pub(super) fn map<T: Sync, R: Send>(
    items: &[T],
    work: impl Fn(usize, &T) -> R + Sync + Send,
) -> Vec<R> {
    let work = |(k, item)| work(k, item);
    if alone() {
        items.iter().enumerate().map(work).collect()
    } else {
        items.par_iter().enumerate().map(work).collect()
    }
}
