//! Processor time of this process: work of others on the same machine does not count.

/// Seconds that this process's threads have run, where the system tells (Linux: to the nanosecond).
pub fn processor_seconds() -> Option<f64> {
    let threads = std::fs::read_dir("/proc/self/task").ok()?;
    let seconds = threads.map(|thread| {
        // A thread that ends while it is read has nothing more to say.
        let text = std::fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        let nanoseconds: f64 = text.split_whitespace().next()?.parse().ok()?;
        Some(1e-9 * nanoseconds)
    });
    let known: Vec<_> = seconds.flatten().collect();
    (!known.is_empty()).then(|| known.iter().sum())
}
