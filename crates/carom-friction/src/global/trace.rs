use super::compliance::Compliance;
use super::control::CONTROL;

/// A trace and how sure it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Trace {
    pub value: f64,
    /// Three standard deviations, relative to the value; 0 where it is exact.
    pub uncertainty: f64,
}

impl<const D: usize> Compliance<'_, D> {
    /// tr W. A part with no more columns of H than are solved for at once gives its share column by column. A larger one gives the
    /// mean of xᵀ W x over as many vectors x of random signs [M. F. Hutchinson, Commun. Stat. Simul. Comput. 18 (1989) 1059–1076].
    pub fn trace(&self) -> Trace {
        let mut memory = self.inverse.memory(CONTROL.at_once);
        let (mut forces, mut x) = (Vec::new(), Vec::new());
        let (mut value, mut variance) = (0.0, 0.0);
        let mut signs = Signs::default();
        for part in 0..self.inverse.parts.len() {
            let links = self.incidence.of_part(part);
            let columns = links.len() * D;
            let exact = columns <= CONTROL.at_once;
            let n = self.inverse.parts.dofs(part).len();
            forces.clear();
            forces.resize(n * columns.min(CONTROL.at_once), 0.0);
            for (k, link) in links.enumerate() {
                for d in 0..D {
                    for (probe, force) in forces.chunks_exact_mut(n).enumerate() {
                        let weight =
                            if exact { f64::from(u8::from(probe == k * D + d)) } else { signs.next() };
                        if weight != 0.0 {
                            for (dof, row) in self.incidence.rows(link) {
                                force[self.inverse.parts.place_of(dof)] += weight * row[d];
                            }
                        }
                    }
                }
            }
            x.clone_from(&forces);
            self.inverse.solve_part(part, &mut x, &mut memory);
            let shares = x.chunks_exact(n).zip(forces.chunks_exact(n));
            let shares = shares.map(|(x, force)| x.iter().zip(force).map(|(x, f)| x * f).sum::<f64>());
            if exact {
                value += shares.sum::<f64>();
            } else {
                let count = CONTROL.at_once as f64;
                let mean = shares.clone().sum::<f64>() / count;
                value += mean;
                variance += shares.map(|s| (s - mean).powi(2)).sum::<f64>() / (count * (count - 1.0));
            }
        }
        Trace { value, uncertainty: if variance > 0.0 { 3.0 * variance.sqrt() / value } else { 0.0 } }
    }
}

/// Random signs, the same in every run.
struct Signs(u64);

impl Default for Signs {
    fn default() -> Self {
        Self(0x9e37_79b9_7f4a_7c15)
    }
}

impl Signs {
    /// xorshift64 [G. Marsaglia, J. Stat. Softw. 8 (2003) 14].
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        if self.0 >> 63 == 0 { 1.0 } else { -1.0 }
    }
}
