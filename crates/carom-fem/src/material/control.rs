//! Every threshold of the laws.

/// What is round-off of a strain, and how long is iterated at a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Control {
    /// Principal values whose squares of stretch differ by less than this, relatively, are taken as equal. There the divided difference of
    /// their stresses is the mean of its limits, whose error is of second order.
    pub coincident: f64,
    /// Sweeps of Jacobi's rotations after which a tensor is taken as diagonal; a handful suffices for any that is finite.
    pub sweeps: usize,
    /// Below this change of strain the correction of the discrete gradient, of its third order, is smaller than round-off.
    pub small_strain: f64,
    /// Growth of tr C from which strains are large.
    pub large_strain: f64,
    /// Increments below this are round-off of a point that has already flowed to its yield stress.
    pub no_flow: f64,
    /// Newton steps in search of the F₃₃ of plane stress; a handful are needed.
    pub steps: usize,
    /// The last correction, relative to F₃₃, after which there is none but round-off.
    pub converged: f64,
}

/// The thresholds of all laws.
pub(crate) const CONTROL: Control = Control {
    coincident: 1e-5,
    sweeps: 30,
    small_strain: 1e-6,
    large_strain: 1.0,
    no_flow: 1e-14,
    steps: 60,
    converged: 1e-9,
};
