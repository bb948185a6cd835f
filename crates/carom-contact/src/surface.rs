use std::collections::BTreeMap;

use carom_mesh::{CellKind, Facet, Surface, Vector};

use crate::aabb::Aabb;
use crate::ball::Ball;
use crate::curve::Curve;
use crate::edge::Edge;
use crate::patch::Patch;
use crate::path::Positions;
use crate::project::{Projection, Reach, Weights, area_normal, normal, project};
use crate::sheet::Sheet;
use crate::sides::Sides;
use crate::tolerances::EDGES;

/// The boundary of a body, its nodes numbered over all bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurface {
    /// Facets.
    pub facets: Vec<Facet>,
    /// Nodes, ascending.
    pub nodes: Vec<u32>,
    /// The nodes that may touch a target, ascending: all but those that follow another. The two would be one contact twice.
    pub sources: Vec<u32>,
    /// Whether this is the meridian of a body of revolution about the second axis, so that every point stands for a circle.
    pub is_meridian: bool,
    /// For every source, the facets around it and its images.
    facets_around: Vec<Vec<u32>>,
    /// For every source, the facets of this surface that it never touches, ascending; empty if it touches none of them.
    pub(crate) never_touched: Vec<Vec<u32>>,
    /// Its convex edges in space, by their nodes.
    pub(crate) edges: Vec<Edge>,
    /// Its other edges: an edge of an obstacle may lie on the facets beside them, with no node near.
    pub(crate) flat_edges: Vec<Edge>,
    /// Whether some of the convex ones are features.
    pub(crate) has_features: bool,
    /// The node that every image follows.
    masters: BTreeMap<u32, u32>,
    shape: Shape,
    /// The sides of its nodes, once it is [`sided`](Self::sided).
    sides: Sides,
    /// What it is before obstacles without corners and other balls, if that is round.
    pub(crate) ball: Option<Ball>,
}

/// What a surface is between its nodes.
#[derive(Debug, Clone, PartialEq)]
enum Shape {
    /// Its facets.
    Faceted,
    /// A curve with one segment per facet.
    Curved(Curve),
    /// A smooth surface in space over some of its facets.
    Tiled(Sheet),
}

impl ContactSurface {
    /// The boundary of a body whose first node has the number `first_node`, with its edges if it is one in space, convex ones and all others.
    /// They are those of the `reference` configuration [m]. As a target it consists of its facets.
    #[must_use]
    pub fn new<const D: usize>(surface: &Surface, first_node: u32, reference: &Positions<'_, D>) -> Self {
        Self::without_edges(surface, first_node).edged(reference)
    }

    fn without_edges(surface: &Surface, first_node: u32) -> Self {
        let facets: Vec<Facet> = surface.facets().iter().map(|f| f.numbered_from(first_node)).collect();
        let nodes: Vec<u32> = surface.nodes().iter().map(|n| n + first_node).collect();
        let masters: BTreeMap<u32, u32> =
            surface.ties().iter().map(|t| (t.image + first_node, t.master + first_node)).collect();
        let sources: Vec<u32> = nodes.iter().copied().filter(|n| !masters.contains_key(n)).collect();
        let mut facets_around = vec![Vec::new(); sources.len()];
        for (f, facet) in facets.iter().enumerate() {
            for node in &facet.nodes {
                if let Ok(k) = sources.binary_search(masters.get(node).unwrap_or(node)) {
                    facets_around[k].push(f as u32);
                }
            }
        }
        Self {
            facets,
            nodes,
            sources,
            is_meridian: false,
            facets_around,
            never_touched: Vec::new(),
            edges: Vec::new(),
            flat_edges: Vec::new(),
            has_features: false,
            masters,
            shape: Shape::Faceted,
            sides: Sides::default(),
            ball: None,
        }
    }

    /// Points without facets, such as that of a particle: they may touch others, and nothing can touch them. `nodes` are ascending.
    #[must_use]
    pub fn of_points(nodes: Vec<u32>) -> Self {
        Self {
            facets: Vec::new(),
            facets_around: vec![Vec::new(); nodes.len()],
            sources: nodes.clone(),
            nodes,
            is_meridian: false,
            never_touched: Vec::new(),
            edges: Vec::new(),
            flat_edges: Vec::new(),
            has_features: false,
            masters: BTreeMap::new(),
            shape: Shape::Faceted,
            sides: Sides::default(),
            ball: None,
        }
    }

    /// The same boundary, before obstacles without corners and before others that are round a ball with this `centre` and `radius` where the nodes are at
    /// `reference` [m]; as it was if its nodes are all in one plane.
    #[must_use]
    pub fn round<const D: usize>(
        self,
        centre: &Vector<D>,
        radius: f64,
        reference: &Positions<'_, D>,
    ) -> Self {
        Self { ball: Ball::new(centre, radius, &self.nodes, reference), ..self }
    }

    /// The same boundary as the meridian of a body of revolution.
    #[must_use]
    pub fn revolved(self) -> Self {
        Self { is_meridian: true, ..self }
    }

    /// The same boundary with a normal that turns continuously from facet to facet. As a target, a line is a cubic curve through its nodes, and
    /// a surface in space a sheet of Gregory patches through them. So the gap of a node is a C¹ function of all positions.
    ///
    /// `reference` are the positions [m] without deformation. Where the boundary turns by more than 40° there it keeps its edge or corner.
    /// Lines of second order stay faceted.
    #[must_use]
    pub fn smoothed<const D: usize>(mut self, reference: &Positions<'_, D>) -> Self {
        if self.facets.iter().all(|f| f.kind == CellKind::Line2) {
            self.shape = Shape::Curved(Curve::through(&self.facets, &|node| self.around(node), reference));
        } else if self.facets.iter().all(|f| f.kind.dimension() == 2) {
            self.shape = Shape::Tiled(Sheet::through(&self.facets, reference));
        }
        self
    }

    /// The same boundary with sides: as the source of a mortar pair it has a multiplier for every side of a node. Facets around the node are on
    /// one side where they go on into one another without a corner or an edge, which is where the boundary turns by more than 40° in
    /// the `reference` configuration [m]. Else a node has one side.
    #[must_use]
    pub fn sided<const D: usize>(self, reference: &Positions<'_, D>) -> Self {
        Self { sides: Sides::of(&self.facets, &|node| self.around(node), reference), ..self }
    }

    /// The side of node `a` of the facet `f` that the facet is on: a number among those of the node.
    pub(crate) fn side(&self, f: u32, a: usize) -> u32 {
        self.sides.of_facet(f, a)
    }

    /// The same boundary without the sources that nothing flat can touch first: those around which it is flat in the `reference`
    /// configuration [m], to 1°.
    pub(crate) fn without_flat_sources<const D: usize>(mut self, reference: &Positions<'_, D>) -> Self {
        let normals: Vec<Vector<D>> =
            self.facets.iter().map(|facet| normal(&Patch::new(facet, reference).middle().tangents)).collect();
        let turns = |around: &[u32]| {
            let of = |f: &u32| &normals[*f as usize];
            around.iter().any(|f| of(f).dot(of(&around[0])) < EDGES.flat)
        };
        let both = self.sources.into_iter().zip(self.facets_around);
        (self.sources, self.facets_around) = both.filter(|(_, around)| turns(around)).unzip();
        self
    }

    /// The node that `node` follows, itself unless it is an image.
    pub(crate) fn master(&self, node: u32) -> u32 {
        *self.masters.get(&node).unwrap_or(&node)
    }

    /// The facets around a source and its images.
    pub(crate) fn around(&self, node: u32) -> &[u32] {
        self.sources.binary_search(&node).map_or(&[], |k| &self.facets_around[k])
    }

    /// Projects `x` on what the surface is over the facet `f`; with `Reach::Beyond` and where it is smooth, also over the next ones.
    #[inline]
    pub(crate) fn project<const D: usize>(
        &self,
        f: u32,
        x: &Vector<D>,
        reach: Reach,
        position: &Positions<'_, D>,
    ) -> Projection<'_, D> {
        match &self.shape {
            Shape::Curved(curve) => curve.project(f, x, reach, position),
            Shape::Tiled(sheet) if sheet.covers(f) => sheet.project(f, x, reach, position),
            Shape::Tiled(_) | Shape::Faceted => project(x, &self.facets[f as usize], reach, position),
        }
    }

    /// At which ends of a facet of the plane, the first and the last, it is smooth but for a concave kink.
    pub(crate) fn concave_kinks<const D: usize>(&self, f: u32, position: &Positions<'_, D>) -> [bool; 2] {
        match &self.shape {
            Shape::Curved(curve) => curve.concave_kinks(f, position),
            Shape::Tiled(_) | Shape::Faceted => [false; 2],
        }
    }

    /// Whether the surface is not what the cells say over a facet.
    pub(crate) fn is_smooth_over(&self, f: u32) -> bool {
        match &self.shape {
            Shape::Curved(curve) => curve.is_curved(f),
            Shape::Tiled(sheet) => sheet.covers(f),
            Shape::Faceted => false,
        }
    }

    /// The nodes that a point of what the surface is over a part of the facet `f` is a combination of; parts are numbered as in `parts`.
    pub(crate) fn nodes_over(&self, f: u32, part: usize) -> &[u32] {
        match &self.shape {
            Shape::Curved(curve) => curve.nodes(f),
            Shape::Tiled(sheet) if sheet.covers(f) => sheet.nodes(f, part),
            Shape::Tiled(_) | Shape::Faceted => &self.facets[f as usize].nodes,
        }
    }

    /// Their weights over the point where the shape functions of the facet are `shape` and the linear ones of the part `of_part`.
    pub(crate) fn weights_over(&self, f: u32, part: usize, shape: &[f64], of_part: &[f64]) -> Weights {
        match &self.shape {
            Shape::Curved(curve) => curve.weights(f, shape[1]),
            Shape::Tiled(sheet) if sheet.covers(f) => sheet.weights(f, part, of_part),
            Shape::Tiled(_) | Shape::Faceted => {
                Weights::from_slice(&shape[..self.facets[f as usize].nodes.len()])
            }
        }
    }

    /// How far `x` is in front of the facet `f` [m], negative behind it.
    pub(crate) fn gap_at<const D: usize>(&self, f: u32, x: &Vector<D>, position: &Positions<'_, D>) -> f64 {
        let p = self.project(f, x, Reach::Facet, position);
        p.normal.dot(&(x - p.point))
    }

    /// A box around the ball that the surface stands for; empty if it stands for none.
    pub(crate) fn round_box<const D: usize>(&self, position: &Positions<'_, D>) -> Aabb<D> {
        let ends = self.ball.iter().flat_map(|ball| {
            let (centre, radius) = (ball.centre(position), Vector::repeat(ball.radius));
            [centre - radius, centre + radius]
        });
        Aabb::of(ends)
    }

    /// A box around what the surface is over the facet `f`.
    pub(crate) fn bounds<const D: usize>(&self, f: u32, position: &Positions<'_, D>) -> Aabb<D> {
        match &self.shape {
            Shape::Curved(curve) => Aabb::of(curve.control_points(f, position)),
            Shape::Tiled(sheet) if sheet.covers(f) => Aabb::of(sheet.control_points(f, position)),
            Shape::Tiled(_) | Shape::Faceted => {
                let facet = &self.facets[f as usize];
                Aabb::of(facet.nodes.iter().map(|&n| position(n))).scaled(overshoot(facet.kind))
            }
        }
    }

    /// Mean outward normal of the facets around a node, weighted by their size; not normalised.
    pub(crate) fn node_normal<const D: usize>(&self, node: u32, position: &Positions<'_, D>) -> Vector<D> {
        self.around(node).iter().fold(Vector::zeros(), |sum, &f| {
            sum + area_normal(&Patch::new(&self.facets[f as usize], position).middle().tangents)
        })
    }
}

/// The largest distance between two nodes of a facet [m].
pub(crate) fn diameter<const D: usize>(facet: &Facet, position: &Positions<'_, D>) -> f64 {
    let nodes = &facet.nodes;
    let from = |(k, a): (usize, &u32)| {
        let x = position(*a);
        nodes[k + 1..].iter().map(|b| (position(*b) - x).norm_squared()).fold(0.0, f64::max)
    };
    nodes.iter().enumerate().map(from).fold(0.0, f64::max).sqrt()
}

/// How far a facet of this kind may bulge out of the box around its nodes, in half sides of the box. It is the largest sum of the
/// absolute values of its shape functions, less 1.
pub(crate) fn overshoot(kind: CellKind) -> f64 {
    match kind.node_count() {
        // Three nodes on a line: 5/4; on a triangle they are its corners.
        3 if kind.dimension() == 1 => 0.25,
        // Six on a triangle: 5/3, at its middle.
        6 => 2.0 / 3.0,
        // Eight on a square: 3, at its middle.
        8 => 2.0,
        // Nine: that of the line, squared.
        9 => 0.5625,
        _ => 0.0,
    }
}
