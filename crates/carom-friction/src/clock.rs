use std::time::{Duration, Instant};

/// The time a solve has, from when it began.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    start: Instant,
    limit: Option<Duration>,
}

/// The time is up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TimeIsUp;

impl Clock {
    /// Starts now.
    pub fn new(limit: Option<Duration>) -> Self {
        Self { start: Instant::now(), limit }
    }

    /// Time since the start.
    pub fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// Time left; None without a limit.
    pub fn left(&self) -> Option<Duration> {
        self.limit.map(|limit| limit.saturating_sub(self.elapsed()))
    }

    /// Whether the time is up.
    pub fn is_over(&self) -> bool {
        self.limit.is_some_and(|limit| self.elapsed() >= limit)
    }

    /// Fails where the time is up.
    pub fn check(&self) -> Result<(), TimeIsUp> {
        if self.is_over() { Err(TimeIsUp) } else { Ok(()) }
    }
}
