//! How a body gives way that is not in stable equilibrium.

use carom_mesh::Vector;

use crate::error::StepError;
use crate::model::assembly::Assembly;
use crate::model::given::Given;

/// How a body gives way.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct GivingWay<const D: usize> {
    pub body: usize,
    /// An entry per node of the body; the largest component is one.
    pub motion: Vec<Vector<D>>,
}

impl<const D: usize> GivingWay<D> {
    /// Where it moves most, and which way, in words that follow the name of the body.
    fn in_words(&self, assembly: &Assembly<D>) -> String {
        let nodes = assembly.nodes(self.body);
        let largest = self.motion.iter().enumerate().max_by(|(_, a), (_, b)| a.norm().total_cmp(&b.norm()));
        let Some((node, motion)) = largest else { return String::new() };
        let list = |x: &[f64]| x.iter().map(|x| format!("{x:.3}")).collect::<Vec<_>>().join(", ");
        let place = &assembly.reference[nodes.start + node];
        let direction = motion.normalize();
        let main = direction.iter().position(|x| x.abs() > 0.99);
        let name =
            main.map_or_else(|| format!("({})", list(direction.as_slice())), |k| ["x", "y", "z"][k].into());
        let digits: Vec<String> = place.iter().map(|x| format!("{x:.3e}")).collect();
        format!(" (it gives way most along {name} where it was at ({}) m)", digits.join(", "))
    }

    /// The error of a step in which the body does so.
    pub fn error(&self, given: &Given<'_, D>) -> StepError {
        let body = given.assembly.name(self.body).to_string();
        let motion = self.in_words(given.assembly);
        // Where there is a bridge, this is said only if it leads nowhere.
        if given.method.bridges {
            StepError::Restless { body, motion }
        } else {
            StepError::Unstable { body, motion }
        }
    }
}
