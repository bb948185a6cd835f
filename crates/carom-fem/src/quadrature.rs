use carom_mesh::CellKind;

/// A quadrature point of a reference cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QuadraturePoint {
    /// Reference coordinates.
    pub xi: [f64; 3],
    /// Weight; the weights of a rule sum to the volume of the reference cell.
    pub weight: f64,
}

/// What a rule must integrate exactly on an affine cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Integrand {
    /// Products of gradients of shape functions: internal forces and stiffness.
    Gradients,
    /// Products of shape functions: mass.
    Values,
}

/// The rule for `kind`: Gauss products on squares and cubes, symmetric rules on simplices
/// (Zienkiewicz & Taylor, *The Finite Element Method*, tables of numerical integration).
#[must_use]
pub fn rule(kind: CellKind, integrand: Integrand) -> Vec<QuadraturePoint> {
    const GAUSS: f64 = 0.577_350_269_189_625_8;
    let simplex = |points: &[[f64; 3]], volume: f64| -> Vec<QuadraturePoint> {
        let weight = volume / points.len() as f64;
        points.iter().map(|&xi| QuadraturePoint { xi, weight }).collect()
    };
    match (kind, integrand) {
        (CellKind::Line2 | CellKind::Quad4 | CellKind::Hex8, _) => kind
            .reference()
            .nodes
            .iter()
            .map(|node| QuadraturePoint { xi: node.map(|x| x * GAUSS), weight: 1.0 })
            .collect(),
        (CellKind::Tri3, Integrand::Gradients) => simplex(&[[1.0 / 3.0, 1.0 / 3.0, 0.0]], 0.5),
        (CellKind::Tri3, Integrand::Values) => {
            const A: f64 = 1.0 / 6.0;
            const B: f64 = 2.0 / 3.0;
            simplex(&[[A, A, 0.0], [B, A, 0.0], [A, B, 0.0]], 0.5)
        }
        (CellKind::Tet4, Integrand::Gradients) => simplex(&[[0.25; 3]], 1.0 / 6.0),
        (CellKind::Tet4, Integrand::Values) => {
            // (5 ∓ √5)/20 and 1 − 3 of it.
            const A: f64 = 0.138_196_601_125_010_5;
            const B: f64 = 0.585_410_196_624_968_5;
            simplex(&[[A, A, A], [B, A, A], [A, B, A], [A, A, B]], 1.0 / 6.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ N_a N_b over the reference cell sums to its volume, and each row to ∫ N_a, for the mass rule.
    #[test]
    fn mass_rules_integrate_products_of_shape_functions() {
        for kind in CellKind::ALL {
            let volume: f64 = rule(kind, Integrand::Gradients).iter().map(|p| p.weight).sum();
            let mut n = vec![0.0; kind.node_count()];
            let mut diagonal = 0.0;
            let mut total = 0.0;
            for point in rule(kind, Integrand::Values) {
                (kind.reference().shape)(&point.xi, &mut n);
                diagonal += point.weight * n[0] * n[0];
                total += point.weight * n.iter().sum::<f64>();
            }
            assert!((total - volume).abs() < 1e-14 * volume);
            // Exact ∫ N² / V: (1/3)^d on products of segments, 2/((d+1)(d+2)) on simplices.
            let exact = match kind {
                CellKind::Line2 => 1.0 / 3.0,
                CellKind::Quad4 => 1.0 / 9.0,
                CellKind::Hex8 => 1.0 / 27.0,
                CellKind::Tri3 => 1.0 / 6.0,
                CellKind::Tet4 => 1.0 / 10.0,
            };
            assert!((diagonal / volume - exact).abs() < 1e-14, "{kind:?}");
        }
    }
}
