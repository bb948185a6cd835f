//! Every threshold of Newton's iterations, with what it was measured by.

/// When iterations of a step have ended, are slow, lead astray or get nowhere, and how well the contacts are solved on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Control {
    /// A correction is the last one where this times its contraction would leave less than what is wanted. The contraction is that of
    /// accelerated iterations, and the last correction stands as it is. Measured: with 10 the energy of conserving runs drifts three times as
    /// far.
    pub safety: f64,
    /// The same where errors do not count so much: in a long step that of the iterations is nothing beside that of the weighted stresses.
    pub less_safety: f64,
    /// No contraction is trusted to be better than this: after a wild guess a correction may look small that is not.
    pub least_contraction: f64,
    /// K̄ is renewed within a step when corrections shrink more slowly than this from one to the next, `patience` iterations after the
    /// last one. Elastic bodies get over what makes them slow, and a factor made there would be a worse one afterwards.
    pub slow_contraction: f64,
    /// See `slow_contraction`.
    pub patience: usize,
    /// As `patience`, counted from the start of the step, where bodies change their behaviour: where there is plastic flow.
    pub changed_patience: usize,
    /// A correction larger than this times the first one, or the motion that the step set out with, leads away from the solution next to
    /// the start. Iterations may well converge from there, to another one: a body buckled or turned inside out.
    pub astray: f64,
    /// Iterations that have not halved the smallest correction for so long get nowhere, and a shorter step is the better chance. Measured on
    /// impacts at up to twenty times the speed of waves: of 568 steps that did not converge, 480 had such a spell. Of 1640 that converged
    /// after more than 12 iterations, 3 had one.
    pub stalled: usize,
    /// Iterations that got so far down, in units of round-off, before they got nowhere have converged: nothing better can be had. A clamped
    /// block on a shaking floor stalls at 3.5; where steps do not converge, stalls at less than 200 have not been seen.
    pub unavoidable: f64,
    /// Contacts from which their problem costs so much that it is solved no better than an iteration needs that is not the last one.
    pub many_contacts: usize,
    /// What its solution may then be wrong by, in corrections that are expected.
    pub loose: f64,
    /// The same in last corrections, as long as it is not known how fast they shrink.
    pub loose_at_first: f64,
    /// What it may be wrong by in the end, in the correction that is wanted.
    pub part_of_contacts: f64,
    /// An iteration may be the last one if the correction that is expected of it is within so many times of what is wanted.
    pub near: f64,
    /// After so many an iteration is late, and a normal that jumps has crossed a kink of its target, which no smaller correction will undo.
    pub late: usize,
    /// After so many, reactions are given their stiffness in blended steps. Thirty discs that settle: 47 s with 6, 6.8 s with 12, 4.7 s with 16.
    pub blended_late: usize,
    /// The blend of massless contact is weighed anew in so many iterations. Where little can be moved, its weight may have no fixed point.
    pub weighed: usize,
    /// A free body whose corrections shrink faster than this is not accelerated: it would cost more than it saves.
    pub fast: f64,
    /// Differences of corrections that are parallel up to this, relative and squared, say nothing new to the acceleration.
    pub parallel: f64,
    /// After so many iterations whose corrections still shrink more slowly than `slow_contraction` says, a step in contact goes on by the tangents of a
    /// load step.
    pub endured: usize,
    /// Largest weight of a difference: beyond it the combination is an extrapolation that nothing supports. Still too large for steps ten
    /// times as long as those of the two cylinders, where weights of at most 0.3 hold: see docs/speed.md.
    pub largest_weight: f64,
}

/// The thresholds of every run.
pub(crate) const CONTROL: Control = Control {
    safety: 30.0,
    less_safety: 10.0,
    least_contraction: 1e-3,
    slow_contraction: 0.3,
    patience: 12,
    changed_patience: 3,
    astray: 3.0,
    stalled: 15,
    unavoidable: 100.0,
    many_contacts: 100,
    loose: 1e-3,
    loose_at_first: 1e-9,
    part_of_contacts: 0.03,
    near: 30.0,
    late: 6,
    blended_late: 16,
    weighed: 10,
    fast: 0.05,
    parallel: 1e-12,
    endured: 24,
    largest_weight: 2.0,
};

/// When a correction of a load step is the last one, is refused, or calls for a new tangent, and how much bodies are held back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LoadControl {
    /// A correction is the last one where this times its contraction would leave less than what is wanted.
    pub safety: f64,
    /// A correction so many times as large as anything in the step so far leads astray.
    pub astray: f64,
    /// A motion so many times as large as the largest body is none that anything bears.
    pub runaway: f64,
    /// Iterations that have not halved the smallest correction for so long have stalled,
    pub stalled: usize,
    /// and have converged if they are within so many times of what round-off leaves.
    pub unavoidable: f64,
    /// No round-off is trusted to be more than this, in sizes of the largest body.
    pub trusted: f64,
    /// What the second iteration is thought to leave of the first one's correction.
    pub hoped: f64,
    /// The tangent lacks the stiffness of reactions where corrections of late iterations shrink by less than this.
    pub slow: f64,
    /// A guess is near the solution where the last correction was no more than this, relative to the largest motion of the step.
    pub near: f64,
    /// After so many an iteration is late, and a normal that jumps has crossed a kink of its target, which no smaller correction will undo.
    pub late: usize,
    /// Guesses that may be refused before the step is.
    pub refusals: usize,
    /// The first share where K̄ is indefinite or a guess was refused.
    pub first: f64,
    /// By how much it changes.
    pub change: f64,
    /// The least that is left of what holds a loose body, where contacts hold it but what they hold it to gives way: a slender beam, a soft spring.
    pub loosest: f64,
    /// The share where a free motion is left alone: what it would move in an iteration is small, and its square no gap.
    pub left_alone: f64,
    /// With more of it nothing moves.
    pub largest: f64,
}

/// The thresholds of every load step.
pub(crate) const LOAD_STEP: LoadControl = LoadControl {
    safety: 10.0,
    astray: 3.0,
    runaway: 1.0,
    stalled: 4,
    unavoidable: 100.0,
    trusted: 1e-8,
    hoped: 0.1,
    slow: 0.3,
    near: 1e-4,
    late: 4,
    refusals: 8,
    first: 1e-3,
    change: 4.0,
    loosest: 1e-4,
    left_alone: 1.0,
    largest: 1e4,
};
