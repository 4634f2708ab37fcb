//! The memory of this machine that may still be used.

/// Bytes of memory that are free for this process, swap included; none where the system does not say.
pub(crate) fn free() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let of_machine = of_machine(&read("/proc/meminfo")?)?;
    let group = read("/proc/self/cgroup").as_deref().and_then(group).map(str::to_owned);
    // Inside of a container the group is at the top.
    let places = [group.unwrap_or_default(), String::new()];
    let limits = places.iter().filter_map(|place| read(&format!("/sys/fs/cgroup{place}/memory.max")));
    Some(limits.filter_map(|limit| limit.trim().parse().ok()).fold(of_machine, u64::min))
}

/// What `/proc/meminfo` says of memory that is free or can be made so.
fn of_machine(text: &str) -> Option<u64> {
    let bytes = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(name))?;
        line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?.checked_mul(1024)
    };
    bytes("MemAvailable:")?.checked_add(bytes("SwapFree:").unwrap_or(0))
}

/// The control group of a process, in version 2.
fn group(text: &str) -> Option<&str> {
    text.lines().find_map(|line| line.strip_prefix("0::")).map(|path| path.trim_end_matches('/'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn free_memory_is_what_the_system_says() {
        let text = "MemTotal:  8000 kB\nMemAvailable:    3000 kB\nSwapFree:  1000 kB\n";
        assert_eq!(of_machine(text), Some(4000 * 1024));
        assert_eq!(of_machine("MemTotal:  8000 kB\n"), None);
        assert_eq!(group("12:cpu:/old\n0::/user/session\n"), Some("/user/session"));
        assert_eq!(group("0::/\n"), Some(""));
        if cfg!(target_os = "linux") {
            assert!(free().is_some_and(|bytes| bytes > 1 << 20));
        }
    }
}
