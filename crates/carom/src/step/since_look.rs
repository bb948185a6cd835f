/// What happened to a body since it was looked at for going through itself.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct SinceLook {
    /// How far its nodes have moved against one another, at most [m].
    pub wandered: f64,
    /// Whether it is to be looked at.
    pub is_due: bool,
}
