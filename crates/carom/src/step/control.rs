//! Every threshold of a step but those of its iterations.

/// How far around the bodies contacts are looked for, and how often.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Search {
    /// Margin of the contact search, in largest predicted motions of a node in the step.
    pub margin: f64,
    /// The largest margin, in sizes of the model, where no body moves as a whole by half of that. With more, one very fast node would
    /// turn all nodes into contacts: two bodies whose 60 contacts a step was about had a dense problem of 1245.
    pub largest_margin: f64,
    /// The least margin in a static analysis, where no velocity foretells the motion, in sizes of the model.
    pub static_margin: f64,
    /// How often a step is repeated from where it led to, if something came into contact unforeseen.
    pub repetitions: usize,
    /// How often at most for what the measure has found; after that it is told.
    pub measured: usize,
}

/// Those of every search.
pub(crate) const SEARCH: Search =
    Search { margin: 2.0, largest_margin: 0.1, static_margin: 1e-3, repetitions: 8, measured: 4 };

/// Which contacts land, stick or settle by an impulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Impulsive {
    /// A contact that is pressed by less than this part of what it would take to turn it round has come to its target with the end of the
    /// step, and lands in the next.
    pub has_landed: f64,
    /// What approaches at the end of a step by more than so many times what its landing makes good did not land: see `landing::restoring`.
    pub pushed: f64,
    /// Above this part the reaction itself says whether the contact sticks; below, its direction may be round-off.
    pub is_known: f64,
    /// So often is friction looked for that takes energy at every contact.
    pub rounds: usize,
    /// A contact sticks where its friction is below the limit by more than this part of it.
    pub sticking: f64,
    /// A velocity is at rest where it takes less than this part of the impulse of the step to stop it.
    pub at_rest: f64,
    /// The reactions of closed contacts bear impulses so many times as large as those that would stop single nodes.
    pub borne: f64,
}

/// Those of every impulse.
pub(super) const IMPULSIVE: Impulsive = Impulsive {
    has_landed: 1e-8,
    pushed: 2.0,
    is_known: 1e-4,
    rounds: 4,
    sticking: 1e-6,
    at_rest: 1e-14,
    borne: 2.0,
};

/// When a body has come to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lying {
    /// So many steps it is still before,
    pub steps: u64,
    /// and for this share of its run or stage,
    pub share: f64,
    /// within so many times round-off of where it became still: the root of `steps`, as iterations leave round-off in every one. What nobody sees of
    /// a creep comes to no more than this over `share` in the whole run.
    pub way: f64,
}

/// Those of every body.
pub(super) const RESTING: Lying = Lying { steps: 100, share: 0.01, way: 10.0 };

/// When a body is looked at for touching itself, in diameters of its smallest facet where nothing else is said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Waking {
    /// How far its nodes may move against one another before it is looked at.
    pub unseen: f64,
    /// A body that comes no nearer to itself than this is left alone until the next look: two nodes that move towards one another until
    /// then come nearer by a fifth of it.
    pub near: f64,
    /// The same in motions of the step, where one is long.
    pub near_in_motions: f64,
}

/// Those of every body.
pub(super) const WAKING: Waking = Waking { unseen: 0.05, near: 0.5, near_in_motions: 4.0 };
