/// What happened to a body since it was looked at for touching itself or going through itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SinceLook {
    /// How far its nodes have moved against one another, at most [m].
    pub wandered: f64,
    /// How far in the last step.
    pub in_step: f64,
    /// Whether it is to be looked at.
    pub is_due: bool,
}

impl Default for SinceLook {
    /// Nobody has looked yet.
    fn default() -> Self {
        Self { wandered: f64::MAX, in_step: 0.0, is_due: true }
    }
}
