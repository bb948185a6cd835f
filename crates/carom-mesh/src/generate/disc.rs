use std::f64::consts::FRAC_PI_2;

use super::check::{check, check_size, is_length};
use super::core_block::CoreBlock;
use super::lattice::{Block, Lattice, span};
use crate::{CellKind, Mesh, MeshError, Vector};

/// A disc meshed by an O-grid: a core of `divisions` × `divisions` cells and rings around it, boundary nodes on the circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Radius [m].
    pub radius: f64,
    /// Cells along a side of the core; a quarter of the boundary has as many.
    pub divisions: usize,
    /// Rings of cells around the core; half of `divisions` if not given.
    pub rings: Option<usize>,
}

impl Disc {
    const CORE: CoreBlock = CoreBlock { half_side: 0.5, bulge: 0.15 };

    /// The disc in these cells, with the set surface.
    ///
    /// # Errors
    /// If the radius is not positive, the divisions are zero, or odd while `rings` is not given, or the cells are not of 2D.
    pub fn mesh(&self, kind: CellKind) -> Result<Mesh<2>, MeshError> {
        let mesh = self.lattice(span(kind))?.mesh(kind)?;
        let on_circle = |x: &Vector<2>| is_near((x - Vector::from(self.centre)).norm(), self.radius);
        Ok(mesh.with_facets_on(&[("surface", &on_circle)]))
    }

    /// The disc in quad4 cells.
    ///
    /// # Errors
    /// Those of [`Disc::mesh`].
    pub fn quadrilaterals(&self) -> Result<Mesh<2>, MeshError> {
        self.mesh(CellKind::Quad4)
    }

    /// How many cells the disc has, and how many rings of these.
    pub(super) fn check(&self) -> Result<(usize, f64), MeshError> {
        let n = self.divisions;
        check(is_length(self.radius), "radius", &self.radius, "the radius must be greater than 0 m")?;
        let remedy = "an even number, at least 2, is needed, or an explicit number of rings";
        check(n > 0 && (n % 2 == 0 || self.rings.is_some()), "divisions", &n, remedy)?;
        let rings = self.rings.unwrap_or(n / 2);
        check(rings > 0, "rings", &rings, "at least 1 ring is needed around the core")?;
        Ok((rings, n as f64 * (n as f64 + 4.0 * rings as f64)))
    }

    /// The points of the disc for cells that span so many intervals.
    pub(super) fn lattice(&self, span: usize) -> Result<Lattice<2>, MeshError> {
        let (rings, cells) = self.check()?;
        check_size(cells, &self.divisions)?;
        let (n, rings) = (self.divisions * span, rings * span);
        let centre = Vector::from(self.centre);
        let parameter = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
        let core = |i: usize, j: usize| {
            let (u, v) = (parameter(i), parameter(j));
            let bulge = |w: f64| Self::CORE.bulged(w);
            Vector::from([u * bulge(v), v * bulge(u)]) * (Self::CORE.half_side * self.radius)
        };
        let mut points: Vec<Vector<2>> = Vec::new();
        for j in 0..=n {
            points.extend((0..=n).map(|i| centre + core(i, j)));
        }
        let core_point = |i: usize, j: usize| (j * (n + 1) + i) as u32;
        let mut blocks = vec![Block::new([n, n], |[i, j]| core_point(i, j))];
        // The perimeter of the core counter-clockwise from its lower right corner, side by side.
        let perimeter: Vec<u32> = (0..4 * n)
            .map(|k| match (k / n, k % n) {
                (0, i) => core_point(n, i),
                (1, i) => core_point(n - i, n),
                (2, i) => core_point(0, n - i),
                (_, i) => core_point(i, 0),
            })
            .collect();
        let core_points = points.len();
        for ring in 1..=rings {
            let weight = ring as f64 / rings as f64;
            for (k, &start) in perimeter.iter().enumerate() {
                let angle = (k as f64 / n as f64 - 0.5) * FRAC_PI_2;
                let end = centre + Vector::from([angle.cos(), angle.sin()]) * self.radius;
                points.push(points[start as usize] * (1.0 - weight) + end * weight);
            }
        }
        let point = |ring: usize, k: usize| match ring {
            0 => perimeter[k % (4 * n)],
            _ => (core_points + (ring - 1) * 4 * n + k % (4 * n)) as u32,
        };
        // Ring by ring, from the inside.
        blocks.extend(
            (0..rings / span).map(|cell| Block::new([span, 4 * n], |[ring, k]| point(cell * span + ring, k))),
        );
        Ok(Lattice { points, blocks })
    }
}

/// Whether a point at distance `r` is on a circle or sphere of this radius, of which the next points are far away.
pub(super) fn is_near(r: f64, radius: f64) -> bool {
    (r - radius).abs() <= 1e-6 * radius
}
