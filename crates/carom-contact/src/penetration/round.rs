//! Round bodies inside one another, and inside obstacles without corners: not their meshes, which have corners in them.

use carom_mesh::Vector;

use super::deep::Deep;
use super::shell::Shell;
use crate::Obstacle;
use crate::balls::apart;
use crate::path::Positions;

impl<const D: usize> Shell<D> {
    /// How deep this round body is in another; none if either is what its mesh makes it.
    pub fn round_inside_of(&self, other: &Self) -> Option<Deep<D>> {
        let ((ball, centre), (others, other_centre)) = (self.ball.as_ref()?, other.ball.as_ref()?);
        let (distance, normal) = apart(centre, other_centre);
        let deep = self.round_deep(distance - ball.radius - others.radius, &normal)?;
        Some(Deep { other: Some(other.nearest_to(&deep.at)), ..deep })
    }

    /// How deep this round body is in an obstacle; none if either has corners.
    pub fn round_inside_of_obstacle(
        &self,
        obstacle: &Obstacle<D>,
        position: &Positions<'_, D>,
    ) -> Option<Deep<D>> {
        let (ball, centre) = self.ball.as_ref()?;
        if obstacle.has_corners() {
            return None;
        }
        let (gap, normal) = obstacle.gap(centre, position);
        self.round_deep(gap - ball.radius, &normal)
    }

    /// Its deepest place where its gap before something is that [m], along a normal that points at it.
    fn round_deep(&self, gap: f64, normal: &Vector<D>) -> Option<Deep<D>> {
        let (ball, centre) = self.ball.as_ref()?;
        if gap >= 0.0 {
            return Some(Deep::none());
        }
        let at = centre - normal * ball.radius;
        Some(Deep { depth: -gap, at, facet: Some(self.nearest_to(&at)), other: None })
    }

    /// The smallest of the facets around the node that is nearest to `x`.
    fn nearest_to(&self, x: &Vector<D>) -> u32 {
        let distance = |node: u32| (self.at(node) - x).norm_squared();
        let nearest = self.nodes.iter().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)));
        nearest.map_or(0, |(_, around)| around[0])
    }
}

#[cfg(test)]
mod tests {
    use carom_mesh::{Mesh, Surface, generate};

    use super::*;
    use crate::{Boundaries, ContactSurface, Penetration, RigidShape};

    /// What is found among discs with these centres and radii, whose meshes are octagons, and an obstacle.
    fn measured(discs: &[([f64; 2], f64)], shape: RigidShape<2>) -> Vec<Penetration<2>> {
        let mesh = |(centre, radius)| generate::Disc { centre, radius, divisions: 2, rings: None };
        let meshes: Vec<Mesh<2>> =
            discs.iter().map(|disc| mesh(*disc).quadrilaterals().expect("valid")).collect();
        let (mut firsts, mut nodes) = (Vec::new(), Vec::new());
        for mesh in &meshes {
            firsts.push(nodes.len() as u32);
            nodes.extend_from_slice(mesh.nodes());
        }
        let obstacles = [Obstacle::new(shape).numbered(nodes.len() as u32, nodes.len() as u32 + 1)];
        nodes.push(Vector::zeros());
        let at = |n: u32| nodes[n as usize];
        let outlines: Vec<Surface> = meshes.iter().map(Surface::of).collect();
        let round = |((outline, &first), &(centre, radius)): ((&Surface, &u32), &([f64; 2], f64))| {
            ContactSurface::new(outline, first, &at).round(&Vector::from(centre), radius, &at)
        };
        let surfaces: Vec<ContactSurface> = outlines.iter().zip(&firsts).zip(discs).map(round).collect();
        let mut boundaries =
            Boundaries::new(outlines.iter().zip(firsts), &obstacles, &at).round_as(&surfaces);
        let mut all = Vec::new();
        boundaries.measure(&obstacles, |_| true, &at, |found| all.push(found));
        all
    }

    fn deepest(found: &[Penetration<2>]) -> f64 {
        found.iter().map(|p| p.depth).fold(0.0, f64::max)
    }

    fn floor() -> RigidShape<2> {
        RigidShape::Plane { point: Vector::zeros(), normal: Vector::<2>::new(0.0, 1.0) }
    }

    /// Symptom guarded against: the octagon within a disc was measured, and between its corners nothing was inside anything.
    #[test]
    fn discs_are_as_deep_as_circles() {
        let angle = std::f64::consts::PI / 8.0;
        let [x, y] = [1.98 * angle.cos(), 1.98 * angle.sin()];
        let found = measured(&[([0.0, 2.0], 1.0), ([x, 2.0 + y], 1.0)], floor());
        assert_eq!(found.len(), 2, "each of the two is in the other: {found:?}");
        assert!((deepest(&found) - 0.02).abs() < 1e-12 && found.iter().all(|p| p.arcs == 0.0));
        let found = measured(&[([0.0, 0.97], 1.0)], floor());
        assert!((deepest(&found) - 0.03).abs() < 1e-12, "{found:?}");
        assert!((found[0].at - Vector::<2>::new(0.0, -0.03)).norm() < 1e-12);
        assert!(measured(&[([0.0, 1.01], 1.0), ([2.01, 1.01], 1.0)], floor()).is_empty());
    }

    /// Symptom guarded against: a ball obstacle within a round body was not seen.
    #[test]
    fn a_ball_obstacle_within_a_disc_is_found() {
        let post = RigidShape::Sphere { centre: Vector::<2>::new(0.3, 0.1), radius: 0.05, cavity: false };
        let found = measured(&[([0.0, 0.1], 1.0)], post);
        assert!((deepest(&found) - 0.75).abs() < 1e-12, "{found:?}");
    }
}
