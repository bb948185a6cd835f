//! A rigid motion that nothing resists.

/// A rigid motion of a body that nothing resists and something drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeMotion {
    /// The body.
    pub body: usize,
    /// What drives it [N]: along the axes,
    pub along: [f64; 3],
    /// about them, by the size of the body,
    pub spin: [f64; 3],
    /// and whether it touches anything.
    pub touches: bool,
    /// All that drives free motions, in terms of the sum of the reactions.
    pub driving: f64,
}

impl FreeMotion {
    /// How the motion in D dimensions is called.
    #[must_use]
    pub fn in_words<const D: usize>(&self) -> String {
        in_words(&self.along[..D], &self.spin, self.touches)
    }
}

/// How a rigid motion along and about these axes, of a body that touches others or none, is called.
fn in_words(along: &[f64], spin: &[f64; 3], touches: bool) -> String {
    let size = |axis: &[f64]| axis.iter().map(|x| x * x).sum::<f64>();
    let turns = size(spin) > size(along);
    let (verb, axis) = match (turns, touches) {
        (true, _) => ("turn about", &spin[..]),
        (false, true) => ("slide along", along),
        (false, false) => ("move along", along),
    };
    let length = size(axis).sqrt();
    let main = axis.iter().position(|x| x.abs() > 0.99 * length);
    let name = main.map_or_else(
        || {
            let parts: Vec<String> = axis.iter().map(|x| format!("{:.2}", x / length)).collect();
            format!("({})", parts.join(", "))
        },
        |k| ["x", "y", "z"][k].to_string(),
    );
    format!("{verb} {name}")
}
