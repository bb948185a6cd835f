//! Closed surfaces of the plane: polygons.

use std::fmt;

use carom_mesh::{CellKind, Facet, Vector};

use super::ClosedSurface;
use crate::project::normal;

/// Why corners are not those of a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PolygonDefect {
    /// The space is not the plane.
    NotInPlane,
    /// There are fewer than three corners.
    TooFew {
        /// How many there are.
        corners: usize,
    },
    /// A corner is where the next one is.
    Repeated {
        /// The first of the two.
        corner: usize,
    },
    /// A side runs back along the one before.
    Folded {
        /// The corner between them.
        corner: usize,
    },
    /// Two sides meet that have no corner in common.
    Crossed {
        /// The first corners of the two.
        sides: [usize; 2],
    },
}

impl fmt::Display for PolygonDefect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotInPlane => {
                write!(f, "a polygon is an obstacle of the plane; in space take a box or a surface")
            }
            Self::TooFew { corners } => write!(f, "{corners} corners enclose nothing; give three or more"),
            Self::Repeated { corner } => {
                write!(
                    f,
                    "corner {corner} is where the next one is; give it once, the last side closes by itself"
                )
            }
            Self::Folded { corner } => {
                write!(f, "the sides at corner {corner} lie on one another; leave it out")
            }
            Self::Crossed { sides: [a, b] } => write!(
                f,
                "the sides from corners {a} and {b} meet; give the corners in the order in which they follow one another around"
            ),
        }
    }
}

impl std::error::Error for PolygonDefect {}

impl<const D: usize> ClosedSurface<D> {
    /// The inside of the polygon with these `corners` [m], in either sense of turning.
    ///
    /// # Errors
    /// If they enclose nothing, or its sides touch or cross one another.
    pub fn polygon(mut corners: Vec<Vector<D>>) -> Result<Self, PolygonDefect> {
        check(&corners)?;
        if twice_the_area(&corners) < 0.0 {
            corners.reverse();
        }
        let count = corners.len();
        let side = |k: usize| corners[(k + 1) % count] - corners[k];
        let normals: Vec<_> = (0..count).map(|k| normal(&[side(k), Vector::zeros()])).collect();
        let vertex_normals = (0..count).map(|k| normals[k] + normals[(k + count - 1) % count]).collect();
        let ends = |k: usize| vec![k as u32, ((k + 1) % count) as u32];
        let facets = (0..count).map(|k| Facet { kind: CellKind::Line2, nodes: ends(k) }).collect();
        Ok(Self::of_facets(corners, facets, normals, vertex_normals))
    }
}

/// Twice the area of a triangle [m²], negative if its corners turn clockwise.
fn turn<const D: usize>(a: &Vector<D>, b: &Vector<D>, c: &Vector<D>) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn twice_the_area<const D: usize>(corners: &[Vector<D>]) -> f64 {
    corners.windows(2).map(|side| turn(&corners[0], &side[0], &side[1])).sum()
}

/// Whether the corners are those of a polygon whose sides meet at these alone.
fn check<const D: usize>(corners: &[Vector<D>]) -> Result<(), PolygonDefect> {
    let count = corners.len();
    if D != 2 {
        return Err(PolygonDefect::NotInPlane);
    }
    if count < 3 {
        return Err(PolygonDefect::TooFew { corners: count });
    }
    let at = |k: usize| &corners[k % count];
    if let Some(corner) = (0..count).find(|&k| at(k) == at(k + 1)) {
        return Err(PolygonDefect::Repeated { corner });
    }
    let folds = |k: usize| {
        let [a, b, c] = [at(k), at(k + 1), at(k + 2)];
        turn(a, b, c) == 0.0 && (b - a).dot(&(c - b)) < 0.0
    };
    if let Some(before) = (0..count).find(|&k| folds(k)) {
        return Err(PolygonDefect::Folded { corner: (before + 1) % count });
    }
    for i in 0..count {
        for j in i + 2..count {
            if (j + 1) % count != i && meet([at(i), at(i + 1)], [at(j), at(j + 1)]) {
                return Err(PolygonDefect::Crossed { sides: [i, j] });
            }
        }
    }
    Ok(())
}

/// Whether two segments have a point in common.
fn meet<const D: usize>([a, b]: [&Vector<D>; 2], [c, d]: [&Vector<D>; 2]) -> bool {
    let (c_side, d_side) = (turn(a, b, c), turn(a, b, d));
    let (a_side, b_side) = (turn(c, d, a), turn(c, d, b));
    let on =
        |p: &Vector<D>, q: &Vector<D>, x: &Vector<D>, side: f64| side == 0.0 && (x - p).dot(&(x - q)) <= 0.0;
    c_side * d_side < 0.0 && a_side * b_side < 0.0
        || on(a, b, c, c_side)
        || on(a, b, d, d_side)
        || on(c, d, a, a_side)
        || on(c, d, b, b_side)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::obstacle::convex::cuboid;

    type Vector2 = Vector<2>;

    fn polygon(corners: &[[f64; 2]]) -> Result<ClosedSurface<2>, PolygonDefect> {
        ClosedSurface::polygon(corners.iter().copied().map(Vector2::from).collect())
    }

    const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

    #[test]
    fn a_square_is_as_far_away_as_the_box_in_either_sense() {
        let mut clockwise = SQUARE;
        clockwise.reverse();
        for corners in [SQUARE, clockwise] {
            let surface = polygon(&corners).expect("a polygon");
            let at = [-1.7, -0.9, -0.35, 0.1, 0.3, 0.8, 1.4];
            for x in at.iter().flat_map(|&x| at.map(|y| Vector2::new(x, y))) {
                let (expected, normal) = cuboid(&x, &Vector2::repeat(1.0));
                let (gap, n) = surface.gap(&x);
                assert!((gap - expected).abs() < 1e-14, "{x}: {gap} {expected}");
                let is_unique = expected > 0.0 || x[0].abs() != x[1].abs();
                assert!(!is_unique || (n - normal).norm() < 1e-12, "{x}: {n} {normal}");
            }
        }
    }

    /// Before a dent the nearest corner is one that turns inwards, and what is in the dent is outside.
    #[test]
    fn in_a_dent_one_is_outside() {
        let bracket =
            polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 0.5], [0.0, 1.0]]).expect("a polygon");
        let (gap, normal) = bracket.gap(&Vector2::new(1.0, 0.6));
        let slope = Vector2::new(1.0, 2.0).normalize();
        assert!((gap - 0.1 * slope[1]).abs() < 1e-15 && normal[1] > 0.0, "{gap} {normal}");
        assert!(bracket.gap(&Vector2::new(1.0, 0.4)).0 < 0.0);
        let (gap, _) = bracket.gap(&Vector2::new(2.3, 1.4));
        assert!((gap - 0.5).abs() < 1e-15, "{gap}");
    }

    #[test]
    fn what_encloses_nothing_or_crosses_itself_is_refused() {
        let refused = |corners: &[[f64; 2]]| polygon(corners).expect_err("no polygon");
        assert_eq!(refused(&SQUARE[..2]), PolygonDefect::TooFew { corners: 2 });
        let [a, b, c, d] = SQUARE;
        assert_eq!(refused(&[a, b, c, d, a]), PolygonDefect::Repeated { corner: 4 });
        assert_eq!(refused(&[a, b, [3.0, -1.0], b, c]), PolygonDefect::Folded { corner: 2 });
        assert_eq!(refused(&[a, b, d, c]), PolygonDefect::Crossed { sides: [1, 3] });
        assert_eq!(refused(&[a, b, c, [0.0, -1.0], d]), PolygonDefect::Crossed { sides: [0, 2] });
        let in_space = ClosedSurface::<3>::polygon(vec![Vector::zeros(); 3]).expect_err("not in the plane");
        assert!(in_space.to_string().starts_with("a polygon is an obstacle of the plane"));
    }
}
