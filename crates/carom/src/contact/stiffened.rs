//! What contacts add to the tangents of a load step, and of other steps whose iterations are slow.
//!
//! The tangent of a model in contact is K + G + Hᵀκ H. G = −∂(Hᵀr)/∂u is the stiffness of the reactions themselves, as normals turn and
//! targets curve. Hᵀκ H are springs in the directions that contacts hold, the normal of those that press and all of those that stick, as stiff as the
//! nodes there. They change no solution: a force −κ w goes with them, and w = 0 in these directions (augmented Lagrangian). But without
//! them a body under pressure may have a tangent without an inverse, although contact holds it. They are there where that is so, and nowhere else:
//! where contacts come and go they take guesses to settle, which the contact problem without them does not.
//!
//! Bodies are uncoupled in K̄. It has springs to the ground, B, in place of those between bodies, and what is missing, Ĝ = G + Hᵀκ H − B,
//! lives on the nodes of the contacts, P. With C = Pᵀ K̄⁻¹ P, the compliance that the reduced problem is made of,
//! Pᵀ(K̄ + P Ĝ Pᵀ)⁻¹P = (I + C Ĝ)⁻¹ C (Woodbury), and no factor is needed but K̄'s.
//!
//! Springs and dampers between bodies are in Ĝ too, in every step, and their nodes in P: bodies that they connect are solved for together, however stiff
//! they are.
//!
//! Contacts change by more than their rows say (`gradients.rs`), which the reduced problem may take note of as well.

use carom_contact::Contact;
use carom_mesh::{Matrix, Vector};

use super::active::ActiveSet;
use super::compliance::Compliance;
use super::control::CONTROL;
use super::gradients::{Gradients, NONE};
use super::second_order;
use super::woodbury::Woodbury;
use crate::body::Body;
use crate::model::assembly::Assembly;
use crate::model::given::Given;
use crate::model::state::State;

/// Springs to the ground in K̄ of a body [N/m], by its own nodes, ascending.
pub(crate) type Springs<const D: usize> = Vec<(u32, Matrix<D>)>;

/// What a tangent has of the stiffness of reactions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum OfReactions {
    /// Nothing: elastic bodies that pressure takes little of converge without.
    None,
    /// What makes no W unsymmetric but that of mortar rows.
    Symmetric,
    /// All of it, and rows know how their contacts turn: iterations are those of Newton.
    Whole,
}

/// The tangents of the contacts of a load step.
#[derive(Debug)]
pub(crate) struct Stiffened<const D: usize> {
    /// What K̄ of every body may have, and has where it is indefinite without.
    pub springs: Vec<Springs<D>>,
    /// Whether it has them.
    pub is_sprung: Vec<bool>,
    /// The springs of the model on every body as if they ended at the ground: in K̄ of load steps, and of others that go on as these do.
    of_model: Vec<Springs<D>>,
    /// So many times as stiff are those of a body as the springs of its contacts.
    times: Vec<f64>,
    /// What reactions have of their stiffness where no body has springs.
    pub of_reactions: OfReactions,
    /// κ of every contact [N/m], and in how many directions; zero where it does not press.
    springs_of_contacts: Vec<(f64, usize)>,
    /// P, and the place of every position of the model in it.
    nodes: Vec<usize>,
    places: Vec<u32>,
    /// Ĝ, and (I + C Ĝ)⁻¹ C.
    missing: Woodbury<D>,
    /// What the correction is at P without new reactions [m].
    seen: Vec<f64>,
    /// What mortar rows leave out of the gradients of their gaps.
    left_out: Gradients<D>,
}

/// κ of a contact, by the stiffness of its softest node in the undeformed body.
fn spring<const D: usize>(
    assembly: &Assembly<D>,
    contact: &Contact<D>,
    bodies: &mut [Box<dyn Body<D>>],
) -> f64 {
    let places = contact.stencil().filter_map(|(n, _)| assembly.place_of(n));
    let softest = places.map(|(b, own)| bodies[b].stiffness_at(own as u32)).fold(f64::INFINITY, f64::min);
    if softest.is_finite() { CONTROL.spring * softest } else { 0.0 }
}

/// The directions of its frame that a contact with the reaction `r` holds: none, the normal, or all.
pub(crate) fn held_directions<const D: usize>(r: &Vector<D>, friction: f64) -> usize {
    let across = r.rows(1, D - 1).norm();
    if r[0] <= 0.0 {
        0
    } else if across < friction * r[0] * (1.0 - CONTROL.sliding) {
        D
    } else {
        1
    }
}

/// Writes the springs between the nodes of `contacts` and the ground, in so many directions of each and so many `times` as stiff as κ, to `springs`,
/// body by body.
pub(crate) fn ground<'a, const D: usize>(
    assembly: &Assembly<D>,
    contacts: impl Iterator<Item = (&'a Contact<D>, usize)>,
    times: f64,
    bodies: &mut [Box<dyn Body<D>>],
    springs: &mut [Springs<D>],
) {
    springs.iter_mut().for_each(Vec::clear);
    for (contact, directions) in contacts.filter(|&(_, directions)| directions > 0) {
        let block = projector(&contact.frame, directions) * (times * spring(assembly, contact, bodies));
        for (node, weight) in contact.stencil() {
            let Some((b, own)) = assembly.place_of(node) else { continue };
            springs[b].push((own as u32, block * weight.abs()));
        }
    }
    springs.iter_mut().for_each(merge);
}

/// Adds the springs of the model, where it is displaced by `displacement` [m], to `springs` as if they ended at the ground. What is rigid has none in its K̄.
pub(crate) fn ground_of_model<const D: usize>(
    assembly: &Assembly<D>,
    displacement: &[Vector<D>],
    bodies: &mut [Box<dyn Body<D>>],
    springs: &mut [Springs<D>],
) {
    for spring in &assembly.springs {
        let block = spring.support(displacement);
        for &(node, weight) in &spring.stencil {
            let Some((b, own)) = assembly.place_of(node as usize) else { continue };
            if bodies[b].stiffness_at(own as u32).is_finite() {
                springs[b].push((own as u32, block * weight.abs()));
            }
        }
    }
    springs.iter_mut().for_each(merge);
}

/// Makes one of the springs at every node.
fn merge<const D: usize>(springs: &mut Springs<D>) {
    springs.sort_by_key(|&(node, _)| node);
    springs.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
}

/// The projector on the first so many directions of a frame.
fn projector<const D: usize>(frame: &Matrix<D>, directions: usize) -> Matrix<D> {
    let along = |k: usize| frame.row(k).transpose() * frame.row(k);
    (0..directions).fold(Matrix::zeros(), |sum, k| sum + along(k))
}

impl<const D: usize> Stiffened<D> {
    /// Of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        Self {
            springs: vec![Vec::new(); assembly.body_count()],
            is_sprung: vec![false; assembly.body_count()],
            of_model: vec![Vec::new(); assembly.body_count()],
            times: vec![1.0; assembly.body_count()],
            of_reactions: OfReactions::None,
            springs_of_contacts: Vec::new(),
            nodes: Vec::new(),
            places: vec![NONE; assembly.reference.len()],
            missing: Woodbury::default(),
            seen: Vec::new(),
            left_out: Gradients::default(),
        }
    }

    /// Whether K̄ alone is not the tangent.
    pub fn is_needed(&self) -> bool {
        self.missing.is_needed()
    }

    /// Forgets what was of `bodies` before.
    pub fn clear(&mut self, bodies: &[usize]) {
        self.missing.clear();
        self.left_out.clear();
        self.let_go(bodies);
        self.of_reactions = OfReactions::None;
    }

    /// Has more of the stiffness of reactions from now on, where it `may_be_whole` all of it. W is not symmetric with all of it, which not every solver
    /// bears. And it is there to end what has nearly ended: far away, or where `bodies` have springs or indefinite tangents, it would pass over
    /// states that give way.
    pub fn have_more(&mut self, bodies: &[usize], may_be_whole: bool) {
        let is_held = bodies.iter().all(|&i| !self.is_sprung[i]);
        self.of_reactions = match self.of_reactions {
            OfReactions::None => OfReactions::Symmetric,
            OfReactions::Symmetric if may_be_whole && is_held => OfReactions::Whole,
            known => known,
        };
    }

    /// Takes the springs of the tangents from the contacts that press: those that a step starts with.
    pub fn spring_from_start(
        &mut self,
        assembly: &Assembly<D>,
        state: &State<D>,
        bodies: &mut [Box<dyn Body<D>>],
    ) {
        let holding =
            state.reactions.iter().map(|r| (&r.contact, held_directions(&r.in_cone(), r.friction(assembly))));
        self.spring_from((assembly, &state.displacement), holding, bodies);
    }

    /// The same of those of the present guess, which leads to these displacements [m].
    pub fn spring_from_guess(
        &mut self,
        assembly: &Assembly<D>,
        displacement: &[Vector<D>],
        active: &ActiveSet<D>,
        bodies: &mut [Box<dyn Body<D>>],
    ) {
        let contacts = active.contacts.iter().zip(&active.reactions).zip(&active.friction);
        let holding = contacts.map(|((contact, r), &mu)| (contact, held_directions(r, mu)));
        self.spring_from((assembly, displacement), holding, bodies);
    }

    fn spring_from<'a>(
        &mut self,
        (assembly, displacement): (&Assembly<D>, &[Vector<D>]),
        contacts: impl Iterator<Item = (&'a Contact<D>, usize)>,
        bodies: &mut [Box<dyn Body<D>>],
    ) {
        self.of_model.iter_mut().for_each(Vec::clear);
        ground_of_model(assembly, displacement, bodies, &mut self.of_model);
        ground(assembly, contacts, 1.0, bodies, &mut self.springs);
        for (springs, times) in self.springs.iter_mut().zip(&self.times) {
            springs.iter_mut().for_each(|(_, block)| *block *= *times);
        }
    }

    /// The springs of a body that K̄ is to have now, and how stiff the softest of those of the model is [N/m], zero without and where
    /// contacts press.
    pub fn support(&self, body: usize) -> (Springs<D>, f64) {
        let of_model = &self.of_model[body];
        let softest = of_model.iter().map(|(_, block)| block.trace()).filter(|&k| k > 0.0).reduce(f64::min);
        // What contacts hold is held back by more: where they slide or part, springs may leave it loose.
        let softest = softest.filter(|_| self.springs[body].is_empty());
        let mut springs = of_model.clone();
        if self.is_sprung[body] {
            springs.extend_from_slice(&self.springs[body]);
        }
        (springs, softest.unwrap_or(0.0))
    }

    /// Gives K̄ of a body springs that it has not, or stiffer ones; returns whether there are such.
    pub fn support_more(&mut self, body: usize) -> bool {
        let times = &mut self.times[body];
        if self.springs[body].is_empty() || self.is_sprung[body] && *times > 1.0 {
            return false;
        }
        if self.is_sprung[body] {
            *times = CONTROL.stiffer;
            self.springs[body].iter_mut().for_each(|(_, block)| *block *= CONTROL.stiffer);
        }
        self.is_sprung[body] = true;
        true
    }

    /// No K̄ of `bodies` has springs any more: those of a step before are of no use in the next.
    pub fn let_go(&mut self, bodies: &[usize]) {
        for &i in bodies {
            self.is_sprung[i] = false;
            self.of_model[i].clear();
            self.times[i] = 1.0;
        }
    }

    /// Adds the forces −κ w that go with the springs between contacts to `residual` [N]. The contacts are those of the guess.
    pub fn add_forces(
        &mut self,
        given: &Given<'_, D>,
        active: &ActiveSet<D>,
        motion: &[Vector<D>],
        bodies: &mut [Box<dyn Body<D>>],
        residual: &mut [Vector<D>],
    ) {
        let assembly = given.assembly;
        self.springs_of_contacts.clear();
        let contacts = active.contacts.iter().zip(active.offsets(given, motion));
        for (((contact, offset), r), &mu) in contacts.zip(&active.reactions).zip(&active.friction) {
            let directions = held_directions(r, mu);
            let sprung =
                contact.stencil().filter_map(|(n, _)| assembly.body_of(n)).filter(|b| self.is_sprung[*b]);
            let times = sprung.map(|b| self.times[b]).fold(0.0, f64::max);
            let is_sprung = directions > 0 && times > 0.0;
            let stiffness = if is_sprung { times * spring(assembly, contact, bodies) } else { 0.0 };
            self.springs_of_contacts.push((stiffness, directions));
            if stiffness > 0.0 {
                let mut w = contact.relative(|n| motion[n]);
                w += offset;
                let force = Vector::from_fn(|i, _| if i < directions { -stiffness * w[i] } else { 0.0 });
                contact.add_force(&force, residual);
            }
        }
    }

    /// Makes the tangent at a guess, whose contacts were evaluated and whose bodies know how they yield there.
    pub fn prepare(
        &mut self,
        given: &Given<'_, D>,
        active: &ActiveSet<D>,
        motion: &[Vector<D>],
        compliances: &[Compliance<D>],
    ) {
        let of_contacts = self.of_reactions != OfReactions::None
            || self.springs_of_contacts.iter().any(|&(stiffness, _)| stiffness != 0.0);
        if !of_contacts && given.assembly.springs.is_empty() {
            // Elastic bodies that pressure takes little of converge without, and a round one that turns in another has nothing against it.
            self.missing.clear();
            self.left_out.clear();
            return;
        }
        self.list_nodes(given.assembly, active);
        self.missing.clear();
        self.left_out.clear();
        if of_contacts {
            let of = (self.places.as_slice(), self.of_reactions == OfReactions::Whole);
            self.left_out.make(given, active, motion, of, &mut self.missing);
        }
        self.add_springs(given.assembly, active);
        self.add_springs_of_model(given, motion);
        let nodes = &self.nodes;
        let block =
            |row: usize, column: usize| yields(given.assembly, compliances, nodes[row], nodes[column]);
        // No block is larger than the largest on the diagonal.
        let softest = (0..nodes.len()).filter_map(|k| block(k, k)).map(|b| b.amax()).fold(0.0, f64::max);
        self.missing.make(nodes.len(), CONTROL.negligible / softest, block);
    }

    /// P: the nodes of bodies that contacts or springs act on.
    fn list_nodes(&mut self, assembly: &Assembly<D>, active: &ActiveSet<D>) {
        self.nodes.drain(..).for_each(|n| self.places[n] = NONE);
        let of_contacts = active.contacts.iter().flat_map(|contact| contact.stencil().map(|(n, _)| n));
        self.nodes.extend(of_contacts.filter(|&n| assembly.body_of(n).is_some()));
        let in_use = |b: &usize| active.touched[*b] && self.is_sprung[*b];
        for (b, springs) in self.springs.iter().enumerate().filter(|(b, _)| in_use(b)) {
            let first = assembly.nodes(b).start;
            self.nodes.extend(springs.iter().map(|&(own, _)| first + own as usize));
        }
        self.nodes.extend(assembly.connected().map(|(b, own)| assembly.nodes(b).start + own));
        self.nodes.sort_unstable();
        self.nodes.dedup();
        (0..).zip(&self.nodes).for_each(|(place, &n)| self.places[n] = place);
    }

    /// The place of a node in P.
    fn place(&self, node: usize) -> Option<usize> {
        Some(self.places[node]).filter(|&place| place != NONE).map(|place| place as usize)
    }

    /// Hᵀκ H − B.
    fn add_springs(&mut self, assembly: &Assembly<D>, active: &ActiveSet<D>) {
        for (contact, &(stiffness, directions)) in active.contacts.iter().zip(&self.springs_of_contacts) {
            if stiffness == 0.0 {
                continue;
            }
            let block = projector(&contact.frame, directions) * stiffness;
            for (n, a) in contact.stencil() {
                let Some(row) = self.place(n) else { continue };
                for (m, b) in contact.stencil() {
                    let Some(column) = self.place(m) else { continue };
                    self.missing.add((row, column), block * (a * b));
                }
            }
        }
        let of_contacts = self.springs.iter().enumerate().filter(|(b, _)| self.is_sprung[*b]);
        for (b, springs) in of_contacts.chain(self.of_model.iter().enumerate()) {
            let first = assembly.nodes(b).start;
            for &(own, block) in springs {
                let Some(place) = self.place(first + own as usize) else { continue };
                self.missing.add((place, place), -block);
            }
        }
    }

    /// What springs and dampers between bodies add.
    fn add_springs_of_model(&mut self, given: &Given<'_, D>, motion: &[Vector<D>]) {
        for spring in &given.assembly.springs {
            let stiffness = spring.in_step(given.interval, &given.state.displacement, motion).stiffness();
            spring.each_block(&stiffness, |n, m, block| {
                let (Some(row), Some(column)) = (self.place(n), self.place(m)) else { return };
                self.missing.add((row, column), block);
            });
        }
    }

    /// The node at which bodies together give way most, if a motion that their closed contacts do not see sets energy free. `held` are the directions of
    /// its frame that every contact holds.
    pub fn gives_way(&self, active: &ActiveSet<D>, held: impl Iterator<Item = usize>) -> Option<usize> {
        if !self.is_needed() || self.left_out.is_some() || self.nodes.len() * D > CONTROL.together {
            return None;
        }
        let rows = active.contacts.iter().zip(held).flat_map(|(contact, directions)| {
            (0..directions).map(move |k| {
                let at = |(n, weight): (usize, f64)| {
                    Some((self.place(n)?, contact.frame.row(k).transpose() * weight))
                };
                contact.stencil().filter_map(at).collect::<Vec<_>>()
            })
        });
        let place = second_order::gives_way(self.missing.compliance(), rows)?;
        Some(self.nodes[place])
    }

    /// The block of the compliance between two nodes of P.
    pub fn block(&self, a: usize, b: usize) -> Option<Matrix<D>> {
        Some(self.missing.block(self.place(a)?, self.place(b)?))
    }

    /// Whether W is not symmetric, as rows leave something out of the gradients of their gaps.
    pub fn leaves_out(&self) -> bool {
        self.is_needed() && self.left_out.is_some()
    }

    /// What the row of contact `i` leaves out of the change of what rules it [m] that the correction without new reactions makes.
    pub fn unseen(&self, i: usize) -> Vector<D> {
        let of_place = |(place, part): &(u32, Matrix<D>)| {
            part * Vector::from_column_slice(&self.seen[*place as usize * D..][..D])
        };
        self.left_out.of(i).iter().map(of_place).sum()
    }

    /// What it leaves out of its block of W with another contact.
    pub fn unseen_block(&self, i: usize, other: &Contact<D>) -> Matrix<D> {
        let mut sum = Matrix::zeros();
        for (place, part) in self.left_out.of(i) {
            for (m, weight) in other.stencil() {
                let Some(column) = self.place(m) else { continue };
                sum += part * self.missing.block(*place as usize, column) * weight;
            }
        }
        sum * other.frame.transpose()
    }

    /// Makes what K̄⁻¹ alone gives at P, beside the `motion` so far [m], what the tangent gives.
    pub fn see(&mut self, motion: &[Vector<D>], seen: &mut [Vector<D>]) {
        let components = self.nodes.iter().flat_map(|&n| (0..D).map(move |i| (n, i)));
        let mut correction: Vec<f64> = components.map(|(n, i)| seen[n][i] - motion[n][i]).collect();
        let less = self.missing.yields(&self.missing.resists(&correction));
        correction.iter_mut().zip(less).for_each(|(c, less)| *c -= less);
        for (&n, c) in self.nodes.iter().zip(correction.chunks_exact(D)) {
            seen[n] = motion[n] + Vector::from_column_slice(c);
        }
        self.seen = correction;
    }

    /// Adds what stands in K̄ for the tangent to the `change` of forces [N] by new reactions: −Ĝ c, with the correction c = s + C f that they lead to.
    pub fn stand_in(&self, change: &mut [Vector<D>]) {
        let forces: Vec<f64> = self.nodes.iter().flat_map(|&n| change[n].iter().copied()).collect();
        let mut correction = self.missing.yields(&forces);
        correction.iter_mut().zip(&self.seen).for_each(|(c, seen)| *c += seen);
        let resisted = self.missing.resists(&correction);
        for (&n, force) in self.nodes.iter().zip(resisted.chunks_exact(D)) {
            change[n] -= Vector::from_column_slice(force);
        }
    }
}

/// The block of C between two nodes, if they are of one body.
fn yields<const D: usize>(
    assembly: &Assembly<D>,
    compliances: &[Compliance<D>],
    n: usize,
    m: usize,
) -> Option<Matrix<D>> {
    let (b, own) = assembly.place_of(m)?;
    if assembly.body_of(n) != Some(b) {
        return None;
    }
    let turn = &compliances[b].turn;
    compliances[b].block(n - (m - own), own).map(|block| turn * block * turn.transpose())
}
