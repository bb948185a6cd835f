use std::f64::consts::FRAC_PI_4;

use super::check::{check, check_size, is_length};
use super::core_block::CoreBlock;
use super::disc::is_near;
use super::lattice::{Block, Lattice, span, unravel};
use crate::{CellKind, Mesh, MeshError, Vector};

/// A ball meshed by an O-grid: a core of `divisions`³ cells and shells around its six sides, boundary nodes on the sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre [m].
    pub centre: [f64; 3],
    /// Radius [m].
    pub radius: f64,
    /// Cells along an edge of the core; a quarter of a great circle has as many.
    pub divisions: usize,
    /// Shells of cells around the core; half of `divisions` if not given.
    pub rings: Option<usize>,
}

impl Ball {
    /// With these two numbers the least of the scaled Jacobians at corners is 0.68 at 2 divisions and 0.76 at 16; the shortest edge
    /// is 0.7 radius / divisions.
    const CORE: CoreBlock = CoreBlock { half_side: 0.45, bulge: 0.1 };

    /// The ball in these cells, with the set surface.
    ///
    /// # Errors
    /// If the radius is not positive, the divisions are zero, or odd while `rings` is not given, or the cells are not of 3D. Also if
    /// they are wedges, which would not meet at the sides of the core.
    pub fn mesh(&self, kind: CellKind) -> Result<Mesh<3>, MeshError> {
        let n = self.divisions;
        check(is_length(self.radius), "radius", &self.radius, "the radius must be greater than 0 m")?;
        let remedy = "an even number, at least 2, is needed, or an explicit number of rings";
        check(n > 0 && (n % 2 == 0 || self.rings.is_some()), "divisions", &n, remedy)?;
        let rings = self.rings.unwrap_or(n / 2);
        check(rings > 0, "rings", &rings, "at least 1 ring is needed around the core")?;
        let remedy =
            "the sides of its core have cells on them that point in three directions; take hex or tet cells";
        check(!kind.is_wedge(), "cell", &kind.reference().name, remedy)?;
        check_size((n as f64).powi(2) * (n as f64 + 6.0 * rings as f64), &n)?;
        let span = span(kind);
        let mesh = self.lattice(n * span, rings * span).mesh(kind)?;
        let on_sphere = |x: &Vector<3>| is_near((x - Vector::from(self.centre)).norm(), self.radius);
        Ok(mesh.with_facets_on(&[("surface", &on_sphere)]))
    }

    /// The points of a ball with `n` intervals along an edge of the core and so many shells around it.
    fn lattice(&self, n: usize, shells: usize) -> Lattice<3> {
        let centre = Vector::from(self.centre);
        let counts = [n + 1; 3];
        let in_core = |place: [usize; 3]| (place[2] * (n + 1) + place[1]) * (n + 1) + place[0];
        // −1 … 1 over the core.
        let parameter = |place: [usize; 3]| Vector::from(place.map(|i| 2.0 * i as f64 / n as f64 - 1.0));
        let mut points: Vec<Vector<3>> = Vec::new();
        // For each point of the core its number among those on its sides.
        let mut on_sides = vec![0; counts.iter().product()];
        let mut sides = Vec::new();
        for index in 0..on_sides.len() {
            let place = unravel(index, counts);
            points.push(centre + Self::core(parameter(place)) * (Self::CORE.half_side * self.radius));
            if place.iter().any(|&i| i == 0 || i == n) {
                on_sides[index] = sides.len();
                sides.push(index);
            }
        }
        let core_points = points.len();
        for shell in 1..=shells {
            let weight = shell as f64 / shells as f64;
            for &index in &sides {
                let end = centre + Self::direction(parameter(unravel(index, counts))) * self.radius;
                points.push(points[index] * (1.0 - weight) + end * weight);
            }
        }
        let point = |place: [usize; 3], shell: usize| match shell {
            0 => in_core(place) as u32,
            _ => (core_points + (shell - 1) * sides.len() + on_sides[in_core(place)]) as u32,
        };
        let mut blocks = vec![Block::new([n; 3], |place| point(place, 0))];
        for axis in 0..3 {
            for end in [0, n] {
                blocks.push(Block::new([n, n, shells], |[a, b, shell]| {
                    // Two directions along the side that make a right-handed triad with the one outward.
                    let (a, b) = if end == 0 { (b, a) } else { (a, b) };
                    let mut place = [end; 3];
                    place[(axis + 1) % 3] = a;
                    place[(axis + 2) % 3] = b;
                    point(place, shell)
                }));
            }
        }
        Lattice { points, blocks }
    }

    /// The place in the core of a point of the cube −1 … 1.
    fn core(u: Vector<3>) -> Vector<3> {
        let bulge = |w: f64| Self::CORE.bulged(w);
        Vector::from_fn(|k, _| u[k] * bulge(u[(k + 1) % 3]) * bulge(u[(k + 2) % 3]))
    }

    /// The direction in which a point of the cube −1 … 1 is seen: lines of equal angles on each side (Ronchi et al. 1996,
    /// "The cubed sphere").
    fn direction(u: Vector<3>) -> Vector<3> {
        (u / u.amax()).map(|c| (c * FRAC_PI_4).tan()).normalize()
    }
}
