//! One change of volume per cell (Simo, Taylor & Pister 1985). The law sees F̂ = (J̄/J)^⅓ F, with J̄ = Σ w J / Σ w the mean of
//! J = det F over the points of the cell. So det F̂ = J̄. The energy of a cell is Σ w ψ(F̂).

use carom_mesh::tensor;

use crate::material::{Mat3, Tangent};

/// The points of a cell: their reference volumes [m³] and deformation gradients.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cell<'a> {
    pub weights: &'a [f64],
    pub f: &'a [Mat3],
}

/// The derivatives of the energy of a cell that couple its points, all as nodal forces when applied to the gradients of the nodes.
pub(crate) struct Coupling {
    /// Volume of the deformed cell v = Σ w J [m³].
    pub volume: f64,
    /// (Σ w c/v − p̄)/v, see [`Cell::tangents`].
    pub stiffness: f64,
}

impl Cell<'_> {
    /// v = Σ w J [m³] and J̄.
    fn volume(&self) -> (f64, f64) {
        let volume: f64 = self.weights.iter().zip(self.f).map(|(w, f)| w * f.determinant()).sum();
        (volume, volume / self.weights.iter().sum::<f64>())
    }

    /// Writes F̂ to `out`. Where J̄ and J are not of one sign it is not a number.
    pub fn modify(&self, out: &mut [Mat3]) {
        let (_, mean) = self.volume();
        for (out, f) in out.iter_mut().zip(self.f) {
            *out = f * (mean / f.determinant()).powf(1.0 / 3.0);
        }
    }

    /// p̄ = Σ w p / v [Pa] with p = ⅓ P̂:F̂, for the stresses P̂ of the law at F̂.
    fn mean_pressure(&self, volume: f64, modified: &[Mat3], stresses: &[Mat3]) -> f64 {
        let points = self.weights.iter().zip(modified.iter().zip(stresses));
        points.map(|(w, (f, p))| w * p.dot(f) / 3.0).sum::<f64>() / volume
    }

    /// Turns the stresses P̂ at F̂ into those whose work is the change of energy: P = (J̄/J)^⅓ P̂ + (p̄ J − p) F⁻ᵀ.
    pub fn stresses(&self, modified: &[Mat3], stresses: &mut [Mat3]) {
        let (volume, mean) = self.volume();
        let mean_pressure = self.mean_pressure(volume, modified, stresses);
        for ((stress, f), modified) in stresses.iter_mut().zip(self.f).zip(modified) {
            let (inverse, j) = tensor::inverse(f);
            let pressure = stress.dot(modified) / 3.0;
            *stress =
                *stress * (mean / j).powf(1.0 / 3.0) + inverse.transpose() * (mean_pressure * j - pressure);
        }
    }

    /// Turns the tangents Â at F̂ into ∂P/∂F at fixed J̄ and p̄. The two stresses that couple the points, J F⁻ᵀ =
    /// ∂J/∂F and G = ∂p/∂F, are written to `swelling` and `pressing`.
    ///
    /// Let Q = Â:F̂ and α = (J̄/J)^⅓. Then c = (Q + P̂):F̂/9 and G = ⅓ α (Q + P̂) − c F⁻ᵀ. ∂P/∂F = α² Â − ⅓ α (Q + P̂) ⊗ F⁻ᵀ +
    /// F⁻ᵀ ⊗ (p̄ J F⁻ᵀ − G) + (p̄ J − p) ∂F⁻ᵀ/∂F. The whole stiffness is that of ∂P/∂F and, with n = Σ w (J F⁻ᵀ) and g = Σ w G
    /// as nodal forces, (g ⊗ n + n ⊗ g)/v + (Σ w c/v − p̄)/v n ⊗ n.
    pub fn tangents(
        &self,
        modified: &[Mat3],
        stresses: &[Mat3],
        tangents: &mut [Tangent<3>],
        swelling: &mut [Mat3],
        pressing: &mut [Mat3],
    ) -> Coupling {
        let (volume, mean) = self.volume();
        let mean_pressure = self.mean_pressure(volume, modified, stresses);
        let mut sum = 0.0;
        for (q, tangent) in tangents.iter_mut().enumerate().take(self.f.len()) {
            let (f, p) = (&modified[q], &stresses[q]);
            let (inverse, j) = tensor::inverse(&self.f[q]);
            let inverse_transposed = inverse.transpose();
            let alpha = (mean / j).powf(1.0 / 3.0);
            let along = Mat3::from_fn(|i, k| {
                let row = &tangent[i][k];
                p[(i, k)] + (0..3).map(|m| (0..3).map(|n| row[m][n] * f[(m, n)]).sum::<f64>()).sum::<f64>()
            });
            let c = along.dot(f) / 9.0;
            let along = along * (alpha / 3.0);
            pressing[q] = along - inverse_transposed * c;
            swelling[q] = inverse_transposed * j;
            sum += self.weights[q] * c;
            let rest = mean_pressure * j - p.dot(f) / 3.0;
            let second = swelling[q] * mean_pressure - pressing[q];
            for i in 0..3 {
                for k in 0..3 {
                    for m in 0..3 {
                        for n in 0..3 {
                            tangent[i][k][m][n] = alpha * alpha * tangent[i][k][m][n]
                                - along[(i, k)] * inverse_transposed[(m, n)]
                                + inverse_transposed[(i, k)] * second[(m, n)]
                                - rest * inverse[(k, m)] * inverse[(n, i)];
                        }
                    }
                }
            }
        }
        Coupling { volume, stiffness: (sum / volume - mean_pressure) / volume }
    }
}
