use std::ops::Range;

use carom_contact::{Boundaries, Candidate, Contact, ContactModel, Pair, Positions, Site, Solid, Target};
use carom_mesh::{Surface, Vector, nodal};

use crate::model::bearing::Bearing;
use crate::model::cohesion::Cohesions;
use crate::model::friction_laws::FrictionLaws;
use crate::model::interference::{Interference, Interferences};
use crate::model::obstacle_motion::ObstacleMotion;
use crate::model::orthotropy::Orthotropies;
use crate::model::restitution::Restitutions;
use crate::model::springs::Spring;

/// More pairs than these are not listed: where hundreds of bodies may touch, most never come near one another, and no one reads of all.
pub(crate) const MANY_PAIRS: usize = 1000;

/// A named pair of bodies, or of a body and an obstacle, that may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedPair {
    /// The two names.
    pub between: [String; 2],
    /// Friction coefficient; of a law that of contacts that have never slid.
    pub friction: f64,
}

/// A body as the others see it: a name and places.
#[derive(Debug, Clone, PartialEq)]
pub struct Member<const D: usize> {
    /// Name.
    pub name: String,
    /// Reference positions of its nodes [m].
    pub reference: Vec<Vector<D>>,
    /// Its diameter [m].
    pub diameter: f64,
    /// Its whole boundary, by its own nodes, whatever of it may touch others; empty for points.
    pub boundary: Surface,
    /// Which components of the displacement of every node are prescribed; empty where none is.
    pub held: Vec<[bool; D]>,
    /// Whether the nodes that may touch have no mass.
    pub is_massless: bool,
    /// Whether it can turn, which a body of revolution cannot.
    pub turns: bool,
    /// Its nodes on an axis of revolution.
    pub axis: Vec<u32>,
    /// Its nodes, each once and ascending, that iterations of a step move, where the body itself says where the others are; empty where all are.
    pub stepped: Vec<u32>,
}

/// Bodies in their places and what may touch what: all that a step needs to know beside the bodies themselves.
#[derive(Debug)]
pub struct Assembly<const D: usize> {
    /// Who may touch whom; surface i is that of body i.
    pub contact: ContactModel<D>,
    /// By how much pairs are pushed apart.
    pub interferences: Interferences,
    /// The coefficients of restitution of pairs of what is rigid.
    pub restitutions: Restitutions,
    /// The friction laws of pairs whose coefficient depends on the motion.
    pub friction_laws: FrictionLaws,
    /// How pairs hold together.
    pub cohesions: Cohesions,
    /// The areas by which laws that depend on the pressure have it, and cohesion its force; empty where none is needed.
    pub bearing: Bearing,
    /// The pairs whose friction depends on the direction.
    pub orthotropies: Orthotropies<D>,
    /// Springs and dampers between bodies and other places.
    pub springs: Vec<Spring<D>>,
    /// Which bodies have one.
    pub(crate) is_connected: Vec<bool>,
    /// Reference positions of all nodes [m]; after those of the bodies, zero for every obstacle, whose displacement says how far
    /// it has moved.
    pub reference: Vec<Vector<D>>,
    /// How the obstacles move.
    pub obstacle_motions: Vec<ObstacleMotion<D>>,
    /// Number of supports whose forces are recorded.
    pub supports: usize,
    /// Diameter of the largest body [m].
    pub size: f64,
    /// The boundaries of all bodies and obstacles.
    pub(crate) boundaries: Boundaries<D>,
    /// 0, 1, …: the numbers of all bodies.
    pub(crate) everyone: Vec<usize>,
    names: Vec<String>,
    obstacle_names: Vec<String>,
    /// The bodies whose nodes that may touch have no mass, whether there are such, and others too.
    is_massless: Vec<bool>,
    is_mixed: bool,
    /// The bodies that can turn.
    turns: Vec<bool>,
    /// The numbers of the nodes of every body.
    nodes: Vec<Range<usize>>,
    /// Those of them that iterations move, in runs.
    stepped: Vec<Vec<Range<usize>>>,
    body_of_node: Vec<u32>,
    /// The nodes on an axis of revolution, ascending.
    on_axis: Vec<u32>,
    /// Which components of every node and obstacle are prescribed.
    held: Vec<[bool; D]>,
    diameters: Vec<f64>,
    /// The largest coordinate of a node where nothing has moved [m].
    farthest: f64,
}

impl<const D: usize> Assembly<D> {
    /// The assembly of these bodies, whose nodes are numbered one body after the other, and of the contacts between their surfaces and with
    /// the obstacles of these names, which stand still.
    #[must_use]
    pub fn new(members: Vec<Member<D>>, mut contact: ContactModel<D>, obstacle_names: Vec<String>) -> Self {
        assert_eq!(contact.obstacles.len(), obstacle_names.len(), "a name for every obstacle");
        let count: usize = members.iter().map(|m| m.reference.len()).sum();
        let obstacles = contact.obstacles.len();
        let numbered = contact.obstacles.into_iter().enumerate();
        contact.obstacles = numbered
            .map(|(o, obstacle)| obstacle.numbered((count + o) as u32, (count + obstacles) as u32))
            .collect();
        let boundaries: Vec<Surface> = members.iter().map(|m| m.boundary.clone()).collect();
        let mut assembly = Self {
            interferences: Interferences::default(),
            restitutions: Restitutions::default(),
            friction_laws: FrictionLaws::default(),
            cohesions: Cohesions::default(),
            bearing: Bearing::default(),
            orthotropies: Orthotropies::default(),
            springs: Vec::new(),
            is_connected: vec![false; members.len()],
            obstacle_motions: vec![ObstacleMotion::Velocity(Vector::zeros()); obstacles],
            supports: 0,
            size: members.iter().map(|m| m.diameter).fold(0.0, f64::max),
            farthest: members.iter().flat_map(|m| &m.reference).map(Vector::amax).fold(0.0, f64::max),
            everyone: (0..members.len()).collect(),
            is_massless: members.iter().map(|m| m.is_massless).collect(),
            is_mixed: members.iter().any(|m| m.is_massless) && members.iter().any(|m| !m.is_massless),
            turns: members.iter().map(|m| m.turns).collect(),
            names: Vec::with_capacity(members.len()),
            nodes: Vec::with_capacity(members.len()),
            stepped: members.iter().map(runs_of_stepped).collect(),
            body_of_node: Vec::with_capacity(count),
            on_axis: Vec::new(),
            held: Vec::with_capacity(count + obstacles),
            diameters: members.iter().map(|m| m.diameter).collect(),
            reference: Vec::with_capacity(count + obstacles),
            contact,
            obstacle_names,
            boundaries: Boundaries::default(),
        };
        for (i, member) in members.into_iter().enumerate() {
            let first = assembly.reference.len();
            assembly.on_axis.extend(member.axis.iter().map(|&n| first as u32 + n));
            assembly.reference.extend(member.reference);
            let end = assembly.reference.len();
            assembly.nodes.push(first..end);
            assembly.names.push(member.name);
            assembly.body_of_node.resize(end, i as u32);
            assembly.held.resize(end, [false; D]);
            assembly.hold(i, &member.held);
        }
        assembly.reference.resize(count + obstacles, Vector::zeros());
        let bodies = boundaries.iter().zip(assembly.nodes.iter().map(|nodes| nodes.start as u32));
        let position = |n: u32| assembly.reference[n as usize];
        assembly.boundaries = Boundaries::new(bodies, &assembly.contact.obstacles, &position)
            .round_as(&assembly.contact.surfaces);
        assembly.held.resize(count + obstacles, [true; D]);
        assembly
    }

    /// Puts `springs` between its bodies, in place of those that there are.
    pub(crate) fn connect(&mut self, springs: Vec<Spring<D>>) {
        self.is_connected.fill(false);
        for &(node, _) in springs.iter().flat_map(|spring| &spring.stencil) {
            if let Some(body) = self.body_of(node as usize) {
                self.is_connected[body] = true;
            }
        }
        self.springs = springs;
    }

    /// The nodes that springs act on, as body and number in that; obstacles do not respond.
    pub(crate) fn connected(&self) -> impl Iterator<Item = (usize, usize)> {
        let nodes = self.springs.iter().flat_map(|spring| &spring.stencil);
        nodes.filter_map(|&(node, _)| self.place_of(node as usize))
    }

    /// The energy of the springs [J] at these displacements.
    pub(crate) fn spring_energy(&self, displacement: &[Vector<D>]) -> f64 {
        self.springs.iter().map(|spring| spring.energy(displacement)).sum()
    }

    /// Says which components of the nodes of body `index` are prescribed; none if `held` is empty.
    pub(crate) fn hold(&mut self, index: usize, held: &[[bool; D]]) {
        let own = &mut self.held[self.nodes[index].clone()];
        if held.is_empty() { own.fill([false; D]) } else { own.copy_from_slice(held) }
    }

    /// Whether two solids may touch, and so must not be inside one another; of a body with itself that is never meant.
    pub(crate) fn must_not_overlap(&self, [a, b]: [Solid; 2]) -> bool {
        a == b || self.contact.pairs.may_meet([a, b])
    }

    /// The interference of a pair of the contact model.
    pub(crate) fn interference(&self, pair: u32) -> &Interference {
        // Most have none, and are found at once.
        if self.interferences.own.is_empty() {
            return &self.interferences.default;
        }
        self.interferences.of(self.contact.pairs.get(pair as usize).between())
    }

    /// How far apart surfaces may press on one another at time `t` [s], in metres.
    pub(crate) fn reach(&self, t: f64) -> f64 {
        self.interferences.all().map(|interference| interference.reach(t)).fold(0.0, f64::max)
    }

    /// The interference of the pair of two solids that may touch.
    pub(crate) fn interference_between(&self, [a, b]: [Solid; 2]) -> Option<&Interference> {
        self.contact.pairs.may_meet([a, b]).then(|| self.interferences.of(a.pair(b)))
    }

    /// How deep two solids may be inside one another at time `t` [s] by the interference of their pair, in metres.
    pub(crate) fn clearance(&self, between: [Solid; 2], t: f64) -> f64 {
        self.interference_between(between).map_or(0.0, |interference| (-interference.least(t)).max(0.0))
    }

    /// Number of bodies.
    #[must_use]
    pub fn body_count(&self) -> usize {
        self.nodes.len()
    }

    /// Number of nodes of the bodies.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.body_of_node.len()
    }

    /// The numbers of the nodes of body `index`.
    #[inline]
    #[must_use]
    pub fn nodes(&self, index: usize) -> Range<usize> {
        self.nodes[index].clone()
    }

    /// The nodes of body `index` that iterations of a step move, in runs, as numbered in the body. Where the others are is the body's own business: some
    /// it places at the end of a step, and the rest when somebody looks.
    #[inline]
    #[must_use]
    pub fn stepped(&self, index: usize) -> &[Range<usize>] {
        &self.stepped[index]
    }

    /// Such a run as numbered in the model.
    #[inline]
    pub(crate) fn numbered(&self, index: usize, run: &Range<usize>) -> Range<usize> {
        let first = self.nodes[index].start;
        first + run.start..first + run.end
    }

    /// The largest component of `vectors`, which are of all nodes of the model, at those of body `index` that iterations move.
    pub(crate) fn largest(&self, index: usize, vectors: &[Vector<D>]) -> f64 {
        let runs = self.stepped[index].iter().map(|run| nodal::largest(&vectors[self.numbered(index, run)]));
        runs.fold(0.0, f64::max)
    }

    /// The name of body `index`.
    #[must_use]
    pub fn name(&self, index: usize) -> &str {
        &self.names[index]
    }

    /// The name of a body or an obstacle.
    #[must_use]
    pub fn solid_name(&self, solid: Solid) -> &str {
        match solid {
            Solid::Body(i) => self.name(i),
            Solid::Obstacle(o) => &self.obstacle_names[o],
        }
    }

    /// The number of the obstacle of this name.
    pub(crate) fn obstacle(&self, name: &str) -> Option<usize> {
        self.obstacle_names.iter().position(|own| own == name)
    }

    /// The names of two solids.
    pub(crate) fn names(&self, between: [Solid; 2]) -> [String; 2] {
        between.map(|solid| self.solid_name(solid).to_string())
    }

    /// The solids of these names, in ascending order, if they may touch.
    #[must_use]
    pub fn between(&self, names: &[String; 2]) -> Option<[Solid; 2]> {
        let place = |names: &[String], name| names.iter().position(|own| own == name);
        let solid = |name| {
            let body = place(&self.names, name).map(Solid::Body);
            body.or_else(|| place(&self.obstacle_names, name).map(Solid::Obstacle))
        };
        let between = solid(&names[0])?.pair(solid(&names[1])?);
        self.contact.pairs.may_meet(between).then_some(between)
    }

    /// Two solids that may touch, by their names.
    pub(crate) fn named_pair(&self, between: [Solid; 2]) -> NamedPair {
        let friction = self.contact.pairs.of(between).next().map(|p| self.contact.pairs.get(p).friction);
        NamedPair { between: self.names(between), friction: friction.unwrap_or_default() }
    }

    /// What holds a contact of a pair together as long as it is closed [N]: see [`Cohesions::adhesion`].
    pub(crate) fn adhesion(
        &self,
        (pair, site): (u32, Site),
        contact: &Contact<D>,
        position: &Positions<'_, D>,
    ) -> Option<f64> {
        let pair = self.contact.pairs.get(pair as usize);
        self.cohesions.adhesion((&pair, site), contact, &self.bearing, position)
    }

    /// Whether nothing breaks the contacts of a pair, given by its number, that hold.
    pub(crate) fn is_unbreakable(&self, pair: u32) -> bool {
        !self.cohesions.are_none() && self.cohesions.is_unbreakable(&self.contact.pairs.get(pair as usize))
    }

    /// Whether the nodes of body `index` that may touch have no mass.
    #[inline]
    #[must_use]
    pub fn is_massless(&self, index: usize) -> bool {
        self.is_massless[index]
    }

    /// Whether nodes that may touch have mass in some bodies and in others none.
    #[inline]
    #[must_use]
    pub fn is_mixed(&self) -> bool {
        self.is_mixed
    }

    /// Whether body `index` can turn.
    #[must_use]
    pub fn turns(&self, index: usize) -> bool {
        self.turns[index]
    }

    /// The body that a node belongs to; none if it is the position of an obstacle.
    #[inline]
    #[must_use]
    pub fn body_of(&self, node: usize) -> Option<usize> {
        self.body_of_node.get(node).map(|&b| b as usize)
    }

    /// Whether what meets at a candidate can slide. A node on an axis of revolution cannot: it moves along that alone, as does what it meets. With
    /// the axis a little off the normal there would be no telling friction from pressure.
    #[inline]
    #[must_use]
    pub fn can_slide(&self, candidate: &Candidate) -> bool {
        !matches!(candidate.site, Site::Node(node) | Site::Second(node) if self.on_axis.binary_search(&node).is_ok())
    }

    /// The body of a node and its number in that; none if it is the position of an obstacle.
    #[inline]
    #[must_use]
    pub fn place_of(&self, node: usize) -> Option<(usize, usize)> {
        self.body_of(node).map(|b| (b, node - self.nodes[b].start))
    }

    /// Which components of the displacement of a node are prescribed: all of them of an obstacle.
    #[inline]
    #[must_use]
    pub fn held(&self, node: usize) -> &[bool; D] {
        &self.held[node]
    }

    /// The part of a vector at a node that is prescribed: all of it at obstacles.
    #[inline]
    #[must_use]
    pub fn prescribed_part(&self, node: usize, v: &Vector<D>) -> Vector<D> {
        let held = &self.held[node];
        Vector::from_fn(|i, _| if held[i] { v[i] } else { 0.0 })
    }

    /// The part of a vector at a node that can answer to a force: nothing of it at obstacles.
    #[inline]
    #[must_use]
    pub fn free_part(&self, node: usize, v: &Vector<D>) -> Vector<D> {
        v - self.prescribed_part(node, v)
    }

    /// Lengths below this are round-off of the coordinates [m], of small bodies far from the origin too.
    #[must_use]
    pub fn round_off(&self) -> f64 {
        4.0 * f64::EPSILON * self.size.max(self.farthest)
    }

    /// Diameter of the smaller body of a pair [m].
    #[must_use]
    pub fn pair_size(&self, pair: &Pair) -> f64 {
        match pair.target {
            Target::Surface(target) => self.diameters[pair.source].min(self.diameters[target]),
            Target::Obstacle(_) => self.diameters[pair.source],
        }
    }
}

/// The nodes that iterations move, as runs of neighbours.
fn runs_of_stepped<const D: usize>(member: &Member<D>) -> Vec<Range<usize>> {
    if member.stepped.is_empty() {
        return std::iter::once(0..member.reference.len()).collect();
    }
    let runs = member.stepped.chunk_by(|a, b| a + 1 == *b);
    runs.map(|run| run[0] as usize..run[run.len() - 1] as usize + 1).collect()
}
