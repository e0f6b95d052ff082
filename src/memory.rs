//! Large buffers in large pages.

/// Zeros, in huge pages where the system has them: the first touch of a large buffer costs as much as
/// the work on it when it comes in pages of 4 KiB.
pub fn zeros(count: usize) -> Vec<f64> {
    let mut buffer: Vec<f64> = Vec::with_capacity(count);
    advise(&mut buffer);
    buffer.resize(count, 0.0);
    buffer
}

#[cfg(target_os = "linux")]
fn advise(buffer: &mut Vec<f64>) {
    /// Below this a buffer is not worth a call.
    const LEAST: usize = 8 << 20;
    const PAGE: usize = 4096;
    let bytes = buffer.capacity() * size_of::<f64>();
    if bytes < LEAST {
        return;
    }
    let start = (buffer.as_mut_ptr() as usize).next_multiple_of(PAGE);
    let end = (buffer.as_mut_ptr() as usize + bytes) / PAGE * PAGE;
    // SAFETY: whole pages within an allocation that this vector owns; the advice changes no content.
    // Its failure only means small pages.
    unsafe {
        libc::madvise(start as *mut libc::c_void, end - start, libc::MADV_HUGEPAGE);
    }
}

#[cfg(not(target_os = "linux"))]
fn advise(_: &mut Vec<f64>) {}
