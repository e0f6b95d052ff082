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

/// Keeps freed memory for what comes next: given back to the system it would come again as new pages, each
/// to be cleared.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub fn keep_freed() {
    /// The most that may be kept, bytes, and the largest buffer that is.
    const KEPT: libc::c_int = 256 << 20;
    const LARGEST: libc::c_int = 32 << 20;
    /// What the heap grows by.
    const STEP: libc::c_int = 4 << 20;
    // SAFETY: settings of the allocator; their failure changes nothing.
    unsafe {
        libc::mallopt(libc::M_TRIM_THRESHOLD, KEPT);
        libc::mallopt(libc::M_MMAP_THRESHOLD, LARGEST);
        libc::mallopt(libc::M_TOP_PAD, STEP);
    }
}

/// Other allocators have their own ways.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub fn keep_freed() {}
