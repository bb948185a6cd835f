use carom_mesh::Vector;

use super::Line;
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
    /// Where the edges with these lines cross, if these did not end.
    pub fn new(source: &Line<D>, target: &Line<D>) -> Self {
        let (e, f) = (source.chord(), target.chord());
        let offset = source.ends[0] - target.ends[0];
        let along = closest(&e, &f, &offset).map(|s| if s.is_finite() { s } else { 0.5 });
        if source.is_straight() && target.is_straight() {
            return Self::at(&e, &f, &offset, along);
        }
        let along = closest_of_bent(source, target, along);
        let [s, t] = along;
        Self::at(&source.slope(s), &target.slope(t), &(source.at(s) - target.at(t)), along)
    }

    /// Where edges with these tangents cross, `offset` [m] from one another.
    fn at(e: &Vector<D>, f: &Vector<D>, offset: &Vector<D>, along: [f64; 2]) -> Self {
        let product = area_normal(&[*e, *f]);
        let sine = product.norm() / (e.norm_squared() * f.norm_squared()).sqrt();
        // Edges that have become parallel, or points, on the way to a solution: any will do.
        let any = || Vector::from_fn(|i, _| if i == e.iamin() { 1.0 } else { 0.0 });
        let normal = product.try_normalize(0.0).unwrap_or_else(any);
        Self { gap: normal.dot(offset), normal, along, sine: if sine.is_finite() { sine } else { 0.5 } }
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

/// How far along the directions e and f two straight lines are closest whose beginnings are an `offset` apart.
fn closest<const D: usize>(e: &Vector<D>, f: &Vector<D>, offset: &Vector<D>) -> [f64; 2] {
    let (ee, ff, ef) = (e.norm_squared(), f.norm_squared(), e.dot(f));
    let (on_e, on_f) = (e.dot(offset), f.dot(offset));
    let square = ee * ff - ef * ef;
    [(ef * on_f - ff * on_e) / square, (ee * on_f - ef * on_e) / square]
}

/// The same along two lines of which one has a bow, by Newton's method from `along`.
fn closest_of_bent<const D: usize>(source: &Line<D>, target: &Line<D>, along: [f64; 2]) -> [f64; 2] {
    let mut found = along;
    for _ in 0..EDGES.newton {
        let [s, t] = found;
        let (e, f, offset) = (source.slope(s), target.slope(t), source.at(s) - target.at(t));
        let (ee, ff, ef) = (e.norm_squared(), f.norm_squared(), e.dot(&f));
        let (bent_e, bent_f) = (ee + source.turn(s).dot(&offset), ff - target.turn(t).dot(&offset));
        let (straight, bent) = (ee * ff - ef * ef, bent_e * bent_f - ef * ef);
        // Where the lines are far apart for how much they turn, they are taken for straight.
        let is_bent = bent > 0.5 * straight && bent_e > 0.0;
        let (ee, ff, square) = if is_bent { (bent_e, bent_f, bent) } else { (ee, ff, straight) };
        let (on_e, on_f) = (e.dot(&offset), f.dot(&offset));
        let way = [(ef * on_f - ff * on_e) / square, (ee * on_f - ef * on_e) / square];
        if !way.iter().all(|w| w.is_finite()) {
            break;
        }
        found = [0, 1].map(|i| found[i] + way[i].clamp(-1.0, 1.0));
        if way.iter().all(|w| w.abs() <= EDGES.close) {
            break;
        }
    }
    found
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
