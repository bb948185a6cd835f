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

/// The rule for `kind`: Gauss products on squares and cubes, symmetric rules on simplices, products of both on wedges.
///
/// In a body of revolution integrands have the radius as a factor, and the strain of the hoops is made of the shape functions
/// themselves. Gauss products are exact for all of it but N_a N_b/R.
#[must_use]
pub fn rule(kind: CellKind, integrand: Integrand, of_revolution: bool) -> Vec<QuadraturePoint> {
    let degree = kind.reference().degree;
    let simplex_degree = match (integrand, of_revolution) {
        (Integrand::Gradients, false) => 2 * (degree - 1),
        (Integrand::Gradients, true) | (Integrand::Values, false) => 2 * degree,
        (Integrand::Values, true) => 2 * degree + 1,
    };
    match kind {
        CellKind::Line2 | CellKind::Quad4 | CellKind::Hex8 => gauss_2(kind.reference().nodes),
        CellKind::Line3 => gauss_3(CellKind::Line3),
        CellKind::Quad8 | CellKind::Quad9 => gauss_3(CellKind::Quad9),
        CellKind::Hex20 | CellKind::Hex27 => gauss_3(CellKind::Hex27),
        CellKind::Tri3 | CellKind::Tri6 => triangle(simplex_degree),
        CellKind::Tet4 | CellKind::Tet10 => tetrahedron(simplex_degree),
        CellKind::Wedge6 => swept(triangle(2), &gauss_2(CellKind::Line2.reference().nodes)),
        CellKind::Wedge15 => swept(triangle(4), &gauss_3(CellKind::Line3)),
    }
}

/// The points of a triangle at every point of a segment. Slopes along the segment are of the full degree across it, so that
/// stiffness and mass ask for the same rule.
fn swept(triangle: Vec<QuadraturePoint>, segment: &[QuadraturePoint]) -> Vec<QuadraturePoint> {
    let at = |s: &QuadraturePoint, t: QuadraturePoint| QuadraturePoint {
        xi: [t.xi[0], t.xi[1], s.xi[0]],
        weight: s.weight * t.weight,
    };
    segment.iter().flat_map(|s| triangle.iter().map(move |&t| at(s, t))).collect()
}

/// Two Gauss points per direction, in the order of the `corners`: exact for cubics.
fn gauss_2(corners: &[[f64; 3]]) -> Vec<QuadraturePoint> {
    let at = 1.0 / 3.0_f64.sqrt();
    corners.iter().map(|corner| QuadraturePoint { xi: corner.map(|x| x * at), weight: 1.0 }).collect()
}

/// Three Gauss points per direction, in the order of the nodes of `kind`: exact for quintics.
fn gauss_3(kind: CellKind) -> Vec<QuadraturePoint> {
    let at = 0.6_f64.sqrt();
    let weight = |x: &f64| if *x == 0.0 { 8.0 / 9.0 } else { 5.0 / 9.0 };
    let point = |node: &[f64; 3]| QuadraturePoint {
        xi: node.map(|x| x * at),
        weight: node[..kind.dimension()].iter().map(weight).product(),
    };
    kind.reference().nodes.iter().map(point).collect()
}

/// The orbit of (1 − 2a, a, a) in barycentric coordinates: three points.
fn triangle_orbit(a: f64, weight: f64) -> impl Iterator<Item = QuadraturePoint> {
    let b = 1.0 - 2.0 * a;
    [[a, a, 0.0], [b, a, 0.0], [a, b, 0.0]].into_iter().map(move |xi| QuadraturePoint { xi, weight })
}

/// The least rule with positive weights that is exact for polynomials of `degree` ≤ 5 (Dunavant 1985).
fn triangle(degree: usize) -> Vec<QuadraturePoint> {
    match degree {
        0 | 1 => vec![QuadraturePoint { xi: [1.0 / 3.0, 1.0 / 3.0, 0.0], weight: 0.5 }],
        2 => triangle_orbit(1.0 / 6.0, 0.5 / 3.0).collect(),
        3 | 4 => triangle_orbit(0.445_948_490_915_964_9, 0.5 * 0.223_381_589_678_011_47)
            .chain(triangle_orbit(0.091_576_213_509_770_74, 0.5 * 0.109_951_743_655_321_87))
            .collect(),
        _ => {
            let root = 15_f64.sqrt();
            let orbit = |root: f64| triangle_orbit((6.0 + root) / 21.0, (155.0 + root) / 2400.0);
            std::iter::once(QuadraturePoint { xi: [1.0 / 3.0, 1.0 / 3.0, 0.0], weight: 9.0 / 80.0 })
                .chain(orbit(-root))
                .chain(orbit(root))
                .collect()
        }
    }
}

/// The orbit of (1 − 3a, a, a, a) in barycentric coordinates: four points.
fn tetrahedron_orbit(a: f64, weight: f64) -> impl Iterator<Item = QuadraturePoint> {
    let b = 1.0 - 3.0 * a;
    let points = [[a, a, a], [b, a, a], [a, b, a], [a, a, b]];
    points.into_iter().map(move |xi| QuadraturePoint { xi, weight })
}

/// The least rule with positive weights of degree 1, 2 or 5 that is exact for polynomials of `degree` ≤ 5 (Walkington 2000).
fn tetrahedron(degree: usize) -> Vec<QuadraturePoint> {
    let volume = 1.0 / 6.0;
    match degree {
        0 | 1 => vec![QuadraturePoint { xi: [0.25; 3], weight: volume }],
        // (5 − √5)/20.
        2 => tetrahedron_orbit(0.138_196_601_125_010_5, volume / 4.0).collect(),
        _ => {
            let (a, weight) = (0.045_503_704_125_649_65, volume * 0.042_546_020_777_081_47);
            let b = 0.5 - a;
            let edges = [[a, a, b], [a, b, a], [b, a, a], [a, b, b], [b, a, b], [b, b, a]];
            tetrahedron_orbit(0.310_885_919_263_300_6, volume * 0.112_687_925_718_015_85)
                .chain(tetrahedron_orbit(0.092_735_250_310_891_23, volume * 0.073_493_043_116_361_95))
                .chain(edges.into_iter().map(|xi| QuadraturePoint { xi, weight }))
                .collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ ξ^i η^j ζ^k over the reference cell.
    fn exact(kind: CellKind, powers: &[i32]) -> f64 {
        if kind.is_wedge() {
            exact(CellKind::Tri3, &powers[..2]) * exact(CellKind::Line2, &powers[2..])
        } else if kind.is_simplex() {
            // i! j! k! / (i + j + k + d)!
            let factorial = |n: i32| (1..=n).map(f64::from).product::<f64>();
            let sum: i32 = powers.iter().sum();
            powers.iter().map(|&p| factorial(p)).product::<f64>() / factorial(sum + powers.len() as i32)
        } else {
            powers.iter().map(|&p| if p % 2 == 0 { 2.0 / f64::from(p + 1) } else { 0.0 }).product()
        }
    }

    /// Squares and cubes: to that degree in every direction; simplices: to that degree in all; wedges: to that degree in the
    /// triangle and along it.
    #[test]
    fn rules_are_exact_to_the_degree_of_their_integrand() {
        for kind in CellKind::ALL {
            let degree = kind.reference().degree as i32;
            for (integrand, degree) in
                [(Integrand::Gradients, 2 * (degree - 1)), (Integrand::Values, 2 * degree)]
            {
                let points = rule(kind, integrand, false);
                assert!(points.iter().all(|p| p.weight > 0.0));
                let d = kind.dimension();
                let base = degree + 1;
                for m in 0..base.pow(d as u32) {
                    let powers: Vec<i32> = (0..d as u32).map(|k| m / base.pow(k) % base).collect();
                    let of_simplex = if kind.is_wedge() { &powers[..2] } else { &powers[..] };
                    let has_simplex = kind.is_simplex() || kind.is_wedge();
                    if has_simplex && of_simplex.iter().sum::<i32>() > degree {
                        continue;
                    }
                    let monomial =
                        |xi: &[f64; 3]| powers.iter().zip(xi).map(|(&p, x)| x.powi(p)).product::<f64>();
                    let sum: f64 = points.iter().map(|p| p.weight * monomial(&p.xi)).sum();
                    assert!((sum - exact(kind, &powers)).abs() < 1e-14, "{kind:?} {integrand:?} {powers:?}");
                }
            }
        }
    }

    #[test]
    fn simplex_rules_have_the_degree_that_they_are_asked_for() {
        for degree in 0..=5 {
            for (kind, points) in [(CellKind::Tri3, triangle(degree)), (CellKind::Tet4, tetrahedron(degree))]
            {
                let d = kind.dimension();
                for m in 0..6_i32.pow(3) {
                    let powers = [m % 6, m / 6 % 6, m / 36];
                    if powers.iter().sum::<i32>() > degree as i32 || powers[d..].iter().any(|&p| p > 0) {
                        continue;
                    }
                    let monomial =
                        |xi: &[f64; 3]| powers.iter().zip(xi).map(|(&p, x)| x.powi(p)).product::<f64>();
                    let sum: f64 = points.iter().map(|p| p.weight * monomial(&p.xi)).sum();
                    assert!((sum - exact(kind, &powers[..d])).abs() < 1e-16, "{kind:?} {degree} {powers:?}");
                }
            }
        }
    }
}
