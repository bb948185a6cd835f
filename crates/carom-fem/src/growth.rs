use crate::material::Batch;

/// How a body has grown: by the linear strain γ in all three directions, if nothing held it.
///
/// F = F_e (1 + γ), and what has grown is of the same material: an energy ψ(F_e) per volume as it has grown, (1 + γ)³ ψ(F_e) per reference
/// volume. Its Cauchy stress is that of the law at F_e. A law of small displacements sees the strain ε − γ I.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Growth {
    strain: f64,
    /// Whether the law is one of large displacements.
    is_large: bool,
}

impl Growth {
    /// By the linear `strain`, of a material whose law is one of large displacements or not.
    #[must_use]
    pub fn new(strain: f64, is_large: bool) -> Self {
        Self { strain, is_large }
    }

    /// γ.
    #[must_use]
    pub fn strain(&self) -> f64 {
        self.strain
    }

    /// Leaves F_e of the deformation gradients of a batch.
    #[inline]
    pub(crate) fn take_out_of<const D: usize>(&self, f: &mut Batch<D>) {
        if self.strain == 0.0 {
            return;
        }
        let factor = 1.0 / (1.0 + self.strain);
        for (i, row) in f.components.iter_mut().enumerate() {
            for (j, component) in row.iter_mut().enumerate() {
                if self.is_large {
                    component.iter_mut().for_each(|f| *f *= factor);
                } else if i == j {
                    component.iter_mut().for_each(|f| *f -= self.strain);
                }
            }
        }
    }

    /// What an energy that the law gives for F_e counts per reference volume. Its derivatives by F count one and two powers of 1 + γ less.
    pub(crate) fn energy(&self) -> f64 {
        self.power(3)
    }

    /// What a stress of the law counts.
    pub(crate) fn stress(&self) -> f64 {
        self.power(2)
    }

    /// What a tangent of the law counts.
    pub(crate) fn tangent(&self) -> f64 {
        self.power(1)
    }

    fn power(&self, exponent: i32) -> f64 {
        if self.is_large { (1.0 + self.strain).powi(exponent) } else { 1.0 }
    }
}
