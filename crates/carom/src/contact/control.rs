//! Every threshold of contact problems.

/// Which candidates become contacts, which of their directions are held, and how well their problem is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Control {
    /// By how much the margin grows for mortar pairs with every repetition of a search.
    pub widening: f64,
    /// Attempts at a step that may find second facets of nodes: beyond these it ends with what it has.
    pub second_facets: usize,
    /// A contact of which less than this fraction of the normal is free has nothing to move.
    pub unresponsive: f64,
    /// A node this deep inside its target, in sizes of the smaller body, is more than touching it.
    pub inside: f64,
    /// A contact that pressed in the last step is closed up to this gap, in sizes of the smaller body: that far do iterations that end above
    /// round-off let it open.
    pub closed: f64,
    /// Where velocities are ruled, what pressed goes on to press while it is so near to its target, in the ways of a step: one that it flies and the half that it
    /// takes to stop.
    pub stopping: f64,
    /// Contact nodes of a body up to which every pair of them has its block. Beyond these, a node has blocks with those that are
    /// [near](crate::body::Body::near): what W lacks costs iterations, not accuracy.
    pub few: usize,
    /// A direction along a facet that yields less than this where the normal is held, relative to the normal, is held itself.
    pub rigid: f64,
    /// What a held direction yields in W, relative to the normal, where nothing is driven along it, and where something is. Any number
    /// serves, as no force moves it, so long as the prescribed sliding decides the friction.
    pub held_compliance: [f64; 2],
    /// Sliding below this, relative to the motion of the contact, is round-off.
    pub no_sliding: f64,
    /// No contact problem is solved more loosely than this,
    pub loosest: f64,
    /// nor more finely, and in more iterations where that is finer than its solver was given.
    pub finest: f64,
    pub fine_iterations: usize,
    /// A normal that turns so many times as much as the last correction would on a circle of the size of the smaller body has crossed a kink,
    pub kink: f64,
    /// unless it turns by no more than this.
    pub straight: f64,
    /// A reaction this near the edge of Coulomb's cone, relative to it, slides.
    pub sliding: f64,
    /// A contact that holds has opened by more than this, relative to the motions of its problem: farther than its solution is wrong.
    pub opens: f64,
    /// What nothing breaks holds by so many times more than what it was found to pull with.
    pub grip: f64,
    /// The springs of the tangents of load steps, in stiffnesses of nodes: enough for cells that are pressed to 60 %: with 1 the last
    /// of ten steps there took 13 iterations, with 10 no more than 5. Measured on 60 random scenes:
    /// with 1, 10 and 100, wherever something pressed, load steps took 4.6, 4.3 and 4.3 iterations, and 3, 3 and 4 scenes failed.
    pub spring: f64,
    /// How many times as stiff they are where the tangent is indefinite with them: next to a bifurcation, which springs that give way bring
    /// forward. A block between plates that buckles at 49.1 % lost its definite tangent at 48.85 %.
    pub stiffer: f64,
    /// The difference of places that gives the stiffness of reactions, in sizes of the smaller body: it leaves eight digits of it.
    pub difference: f64,
    /// Contacts up to which a dynamic step whose iterations are slow takes the stiffness of reactions. All respond to all then, in a dense matrix
    /// that is made in every iteration: 0.05 s for so many in the plane.
    pub stiffened: usize,
    /// Unknowns at contacts up to which a load step in question asks whether its bodies resist together: 0.1 s for so many.
    pub together: usize,
    /// A contact slips where its reaction, tried against its motion, leaves the cone by more than this, relative to the cone.
    pub slips: f64,
    /// The coefficient of a friction law is found where the law is no farther from it than this, relative to it,
    pub law_settled: f64,
    /// or, after so many rounds,
    pub law_rounds: usize,
    /// no farther than this: what round-off leaves of slow sliding.
    pub law_near: f64,
    /// The smaller of two coefficients by direction is at least so much of the larger one.
    pub narrowest: f64,
    /// No secant goes farther than so many times what the law is off.
    pub law_stride: f64,
    /// What the tangent of a load step has more than K̄ is nothing below this, relative to K̄ at the contacts.
    pub negligible: f64,
}

/// The thresholds of every run.
pub(super) const CONTROL: Control = Control {
    widening: 4.0,
    second_facets: 7,
    unresponsive: 1e-6,
    inside: 1e-6,
    closed: 1e-9,
    stopping: 1.5,
    few: 100,
    rigid: 1e-6,
    held_compliance: [1.0, 1e-3],
    no_sliding: 1e-9,
    loosest: 1e-4,
    finest: 2e-15,
    fine_iterations: 200,
    kink: 1e3,
    straight: 1e-6,
    sliding: 1e-6,
    opens: 1e-9,
    grip: 4.0,
    spring: 10.0,
    stiffer: 100.0,
    difference: 1e-6,
    stiffened: 300,
    together: 1200,
    negligible: 1e-8,
    slips: 1e-9,
    law_settled: 1e-11,
    law_rounds: 20,
    law_near: 1e-8,
    narrowest: 1e-6,
    law_stride: 10.0,
};
