use carom_mesh::Vector;

use crate::project::area_normal;
use crate::tolerances::{EDGES, SEARCH};

/// Two edges where they are closest to one another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing<const D: usize> {
    /// Distance of the lines along the normal [m]; negative = the source has passed the target.
    pub gap: f64,
    /// Unit vector at right angles to both: the direction of source × target; any where that has none.
    pub normal: Vector<D>,
    /// Where the lines are closest, in lengths of the edges from their first nodes: on the source and on the target.
    pub along: [f64; 2],
    /// The sine of the angle between them.
    pub sine: f64,
}

impl<const D: usize> Crossing<D> {
    /// Where edges with these ends [m] cross, if their lines did not end.
    pub fn new(source: [Vector<D>; 2], target: [Vector<D>; 2]) -> Self {
        let (e, f) = (source[1] - source[0], target[1] - target[0]);
        let product = area_normal(&[e, f]);
        let (ee, ff, ef) = (e.norm_squared(), f.norm_squared(), e.dot(&f));
        let offset = source[0] - target[0];
        let (on_e, on_f) = (e.dot(&offset), f.dot(&offset));
        let sine = product.norm() / (ee * ff).sqrt();
        let square = ee * ff - ef * ef;
        // Edges that have become parallel, or points, on the way to a solution: any number will do.
        let safe = |x: f64| if x.is_finite() { x } else { 0.5 };
        let along = [safe((ef * on_f - ff * on_e) / square), safe((ee * on_f - ef * on_e) / square)];
        let any = || Vector::from_fn(|i, _| if i == e.iamin() { 1.0 } else { 0.0 });
        let normal = product.try_normalize(0.0).unwrap_or_else(any);
        Self { gap: normal.dot(&offset), normal, along, sine: safe(sine) }
    }

    /// The same for edges that end half their length beyond their nodes.
    pub fn clamped(self) -> Self {
        Self { along: self.along.map(|s| s.clamp(-SEARCH.beyond, 1.0 + SEARCH.beyond)), ..self }
    }

    /// How far each of the edges reaches beyond where they cross, in its length; negative if it ends before.
    pub fn reach(&self) -> [f64; 2] {
        self.along.map(|s| s.min(1.0 - s))
    }

    /// Which end of each edge is the nearer one.
    pub fn nearer(&self) -> [usize; 2] {
        self.along.map(|s| usize::from(s > 0.5))
    }
}

/// Whether a surface turns away from its outside at an edge `along` which its facets have these normals; the edge goes around the
/// first of them.
pub(super) fn turns_outwards<const D: usize>(along: &Vector<D>, normals: [Vector<D>; 2]) -> bool {
    area_normal(&normals).dot(along) > 0.0
}

/// Whether the direction `n`, at right angles to an edge, is between the normals of its facets. The edge is then what a plane with that
/// normal would meet first (the edge's arc in the Gauss map; Gregorius, Game Developers Conference 2013).
pub(super) fn is_foremost<const D: usize>(
    n: &Vector<D>,
    along: &Vector<D>,
    normals: &[Vector<D>; 2],
) -> bool {
    let along = along.normalize();
    let [first, second] = normals;
    area_normal(&[*first, *n]).dot(&along) >= -EDGES.turn
        && area_normal(&[*n, *second]).dot(&along) >= -EDGES.turn
        && n.dot(&(first + second)) > 0.0
}
