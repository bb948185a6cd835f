//! How much memory there is for what takes most of it.

use std::fs::read_to_string;

use crate::FemError;

/// What takes less is not asked about [bytes]: a gigabyte.
const LARGE: u64 = 1 << 30;

/// Refuses a factor of so many `unknowns` that takes at least `needed` [bytes] where they are not there: a system that has promised more memory than it has
/// kills who takes it, without a word.
pub(super) fn check(unknowns: usize, needed: u64) -> Result<(), FemError> {
    match (needed >= LARGE).then(free).flatten() {
        Some(free) => suffices(unknowns, needed, free),
        None => Ok(()),
    }
}

fn suffices(unknowns: usize, needed: u64, free: u64) -> Result<(), FemError> {
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    if needed <= free {
        return Ok(());
    }
    Err(FemError::Memory { unknowns, needed: gigabytes(needed), free: gigabytes(free) })
}

/// What this process can still have [bytes], of the machine and of the group of processes that it is limited with. None where the system does not say: Linux does.
fn free() -> Option<u64> {
    let machine = of_machine(&read_to_string("/proc/meminfo").ok()?)?;
    let group = || {
        let of = |name: &str| read_to_string(format!("/sys/fs/cgroup/memory.{name}")).ok();
        of_group(&of("max")?, &of("stat")?)
    };
    Some(group().map_or(machine, |group| machine.min(group)))
}

/// The free memory of a machine [bytes], swap included, by its /proc/meminfo.
fn of_machine(meminfo: &str) -> Option<u64> {
    let kilobytes = |name: &str| number_after(meminfo, name);
    Some(1024 * (kilobytes("MemAvailable:")? + kilobytes("SwapFree:").unwrap_or(0)))
}

/// What is left of the limit of a group of processes [bytes], by its memory.max and memory.stat: what it keeps of files the system takes back. None if it has no
/// limit.
fn of_group(max: &str, stat: &str) -> Option<u64> {
    Some(max.trim().parse::<u64>().ok()?.saturating_sub(number_after(stat, "anon")?))
}

/// The number after a name, at the beginning of a line.
fn number_after(text: &str, name: &str) -> Option<u64> {
    let mut lines = text.lines().map(str::split_whitespace);
    lines.find_map(|mut words| (words.next()? == name).then(|| words.next()?.parse().ok()).flatten())
}

#[cfg(test)]
mod tests {
    use super::*;

    const MEMINFO: &str =
        "MemTotal:       24000000 kB\nMemAvailable:   20000000 kB\nSwapFree:        1000000 kB\n";

    #[test]
    fn free_memory_is_what_the_system_says() {
        assert_eq!(of_machine(MEMINFO), Some(21_000_000 * 1024));
        assert_eq!(of_machine("MemTotal: 5 kB"), None);
        assert_eq!(of_group("9000\n", "anon 2000\nfile 6000\n"), Some(7000));
        assert_eq!(of_group("max\n", "anon 2000\n"), None);
        assert_eq!(of_group("1000\n", "anon 2000\n"), Some(0));
    }

    /// Symptom guarded against: the system killed a run whose factor outgrew the memory, and nothing said why.
    #[test]
    fn a_factor_that_outgrows_the_memory_is_refused() {
        assert_eq!(check(1000, LARGE - 1), Ok(()));
        assert_eq!(suffices(1000, 5 << 30, 5 << 30), Ok(()));
        let refused = suffices(600_000, 31_000_000_000, 21_000_000_000).expect_err("31 GB of 21");
        let message = refused.to_string();
        assert!(
            message.starts_with(
                "a factor of 600000 unknowns takes 31.0 GB of memory at least, and 21.0 GB are free: "
            ),
            "{message}"
        );
    }

    /// No machine has as much.
    #[test]
    #[cfg(target_os = "linux")]
    fn linux_says_how_much_there_is() {
        assert!(check(1, u64::MAX).is_err());
    }
}
