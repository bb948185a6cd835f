/// The block of cells in the middle of a disc or a ball, whose sides bulge towards the boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CoreBlock {
    /// Distance of the middle of a side from the centre, relative to the radius.
    pub half_side: f64,
    /// How much sides and edges bulge, relative to half a side.
    pub bulge: f64,
}

impl CoreBlock {
    /// How far out a side is at `w` between −1 and 1 along it, relative to its middle.
    pub fn bulged(&self, w: f64) -> f64 {
        (1.0 + self.bulge * (1.0 - w * w)) / (1.0 + self.bulge)
    }
}
