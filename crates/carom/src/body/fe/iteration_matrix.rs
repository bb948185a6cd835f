//! The iteration matrix K̄ of each body.

use carom_fem::material::PlasticState;
use std::sync::Arc;

use carom_fem::sparse::{Inverse, NodalMatrix, Precision, Sharing};
use carom_fem::{Body, BodyWithHistory, Held};
use carom_mesh::{Matrix, Vector, nodal};

use super::equation::steadied;
use super::light::Light;
use crate::archive::{Archive, CheckpointError};
use crate::body::Tangent;
use crate::error::StepError;
use crate::scheme::StepMap;

/// The inertia of the lowest elastic motion, by its scale (c/L)² [1/s²], c that of shear waves: what corrections of a load step are held back by.
///
/// It is in K̄ alone, never in a residual: each iteration is held back towards the last guess, and the solution is the same.
fn lowest_inertia<const D: usize>(body: &Body<D>) -> f64 {
    (body.shear_wave_speed() / body.mesh().diameter()).powi(2)
}

/// The least share of it that a body has which its supports leave loose: below what a contact resists with, and so far above round-off that a shaft
/// which may turn in a hub does not.
const LOOSE: f64 = 0.05;

/// The same of what springs hold, relative to the softest of them: it leaves that much of an error in every iteration. A mechanism of springs has nothing
/// else against it.
const BESIDE_SPRINGS: f64 = 1e-3;

/// Iterations that a new tangent is worth, of small bodies and of large ones.
const WORTH: [i32; 2] = [3, 12];

/// A pattern of signs without a period, by which round-off of the forces on nodes is summed as chance would.
pub(super) fn sign(k: usize) -> f64 {
    // The bits of the golden ratio (Knuth, multiplicative hashing).
    if (k as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 63 == 0 { 1.0 } else { -1.0 }
}

/// Who has the rest of the matrices of a body, if others have.
fn sharing<const D: usize>(body: &Body<D>) -> Option<Sharing> {
    body.ranks().map(|ranks| Sharing { ranks: Arc::clone(ranks), graph: Arc::clone(body.graph()) })
}

/// Whether what is no sum over cells is counted here: by one rank it is.
fn is_counted<const D: usize>(body: &Body<D>) -> bool {
    body.ranks().is_none_or(|ranks| ranks.is_first())
}

/// The inverse of K̄ = ξ K + ξ/(θΔt) C + M/(θΔt²) (3) of one body: a factor or, for large bodies in short steps, a polynomial in
/// its place ([`Inverse`]). "Factor" stands for both here.
///
/// Reactions never enter K̄, so bodies are uncoupled in it and one factor serves for many steps. It is made in one configuration and applied in the
/// frame that has turned with the body since. (M is isotropic, and the stiffness of an objective law turns with the body.) Newton's iterations then
/// converge linearly but fast, and the factor is renewed where they do not.
///
/// Only the factor knows of tied nodes: it takes and gives vectors of all nodes (see [`carom_fem::sparse::Factor`]), and what starts equal at two of
/// them stays so. Held displacements have rows of their own in K̄: forces on them move nothing. As they are held in the axes of space, such a body's
/// factor does not turn.
#[derive(Debug)]
pub(crate) struct IterationMatrix<const D: usize> {
    inverse: Inverse<D>,
    /// The factors of K, C and M that K̄ was made with.
    coefficients: Option<[f64; 4]>,
    /// See [`lowest_inertia`].
    pub lowest_inertia: f64,
    /// Whether its supports leave the body loose.
    is_loose: bool,
    /// How far round-off of the forces moves the body in a load step [m].
    round_off: f64,
    /// Frame of the body in the configuration of K.
    factor_frame: Matrix<D>,
    /// Rotation since then.
    turn: Matrix<D>,
    /// Grows with every factorisation, so that what was derived from a factor knows when it is stale.
    pub generation: u64,
    held: Held,
    translation: Option<Translation<D>>,
    light: Light,
    scratch: Vec<Vector<D>>,
    origin: Origin<D>,
}

/// Where and for what steps a factor was made: all that it takes to make it again.
#[derive(Debug, Clone)]
struct Origin<const D: usize> {
    /// Length of the steps [s].
    dt: f64,
    /// How much they steadied nodes without mass.
    steadying: f64,
    /// Whether it need not be exact.
    is_approximate: bool,
    /// Frame of the body.
    frame: Matrix<D>,
    /// u [m].
    displacement: Vec<Vector<D>>,
    /// What the material remembered.
    history: Vec<PlasticState>,
    /// How it had grown.
    growth: f64,
}

/// The uniform part of a solution, which mass alone resists: Σ m x = Σ b over the coefficient of M, whatever the stiffness. A factor in
/// single precision would miss it by 10⁻⁷, and momentum with it.
#[derive(Debug)]
struct Translation<const D: usize> {
    nodal_mass: Vec<f64>,
    total_mass: f64,
    /// 1 for the components that are free, 0 for the radial one of a body of revolution.
    free: Vector<D>,
    /// The coefficient of M [1/s²].
    coefficient: f64,
    /// Σ b.
    resultant: Vector<D>,
}

impl<const D: usize> Translation<D> {
    /// None where something else than mass resists: supports, and what steadies nodes without mass.
    fn of(body: &Body<D>) -> Option<Self> {
        let alone = body.held().is_empty() && body.massless().is_empty();
        alone.then(|| Self {
            nodal_mass: body.nodal_mass().to_vec(),
            total_mass: body.total_mass(),
            free: body.resultant(Vector::from_element(1.0)),
            coefficient: 0.0,
            resultant: Vector::zeros(),
        })
    }

    /// What the uniform part of the solution `x` is too small by.
    fn missing(&self, x: &[Vector<D>]) -> Vector<D> {
        let sum = nodal::weighted_total(&self.nodal_mass, x);
        let missing = (self.resultant / self.coefficient - sum) / self.total_mass;
        missing.component_mul(&self.free)
    }
}

impl<const D: usize> IterationMatrix<D> {
    /// Of a body, which may be `connected` to others by springs: as these act on nodes with and without mass, its rows must be symmetric as they are.
    pub fn new(body: &Body<D>, connected: bool) -> Self {
        Self {
            light: if connected { Light::default() } else { Light::of(body) },
            inverse: Inverse::new(body.mesh().ties()).shared(sharing(body)),
            coefficients: None,
            lowest_inertia: lowest_inertia(body),
            is_loose: body.is_loose(),
            round_off: 0.0,
            factor_frame: Matrix::identity(),
            turn: Matrix::identity(),
            generation: 0,
            held: body.held().clone(),
            translation: Translation::of(body),
            scratch: nodal::zeros(body.node_count()),
            origin: Origin {
                dt: 0.0,
                steadying: 0.0,
                is_approximate: false,
                frame: Matrix::identity(),
                displacement: nodal::zeros(body.node_count()),
                history: body.virgin(),
                growth: 0.0,
            },
        }
    }

    /// Whether the factor belongs to steps like `map`.
    pub fn fits(&self, map: &StepMap) -> bool {
        self.inverse.is_made() && self.coefficients == Some(Self::coefficients(map))
    }

    /// How far round-off of the forces moves the body in a load step [m].
    pub fn round_off(&self) -> f64 {
        self.round_off
    }

    /// The factors of K, C and M in K̄, and of what steadies nodes without mass.
    fn coefficients(map: &StepMap) -> [f64; 4] {
        [map.stiffness_coefficient(), map.damping_coefficient(), map.mass_coefficient(), map.steadying]
    }

    /// Whether the factor is exact but for round-off.
    pub fn is_exact(&self) -> bool {
        self.inverse.is_exact()
    }

    /// Records where the present factor was made, or makes it there again: the same factor comes out of the same stiffness. Returns whether
    /// there is a factor that steps may rely on.
    ///
    /// # Errors
    /// If the archive does not fit.
    pub fn exchange(
        &mut self,
        archive: &mut Archive<'_>,
        name: &str,
        body: &Body<D>,
        map: &dyn Fn(f64) -> StepMap,
    ) -> Result<bool, CheckpointError> {
        let name = |of: &str| format!("{name}/{of}");
        let mut has_factor = self.coefficients.is_some();
        archive.flags(&name("has_factor"), [&mut has_factor])?;
        if !has_factor {
            self.forget();
            return Ok(false);
        }
        let mut origin = self.origin.clone();
        archive.numbers(&name("dt"), [&mut origin.dt])?;
        archive.numbers(&name("steadying"), [&mut origin.steadying])?;
        archive.flags(&name("is_approximate"), [&mut origin.is_approximate])?;
        archive.numbers(&name("frame"), origin.frame.iter_mut())?;
        archive.vectors(&name("displacement"), &mut origin.displacement)?;
        archive.plastic(&name("plastic"), &mut origin.history)?;
        archive.numbers(&name("growth"), [&mut origin.growth])?;
        if !archive.replays() {
            return Ok(true);
        }
        if origin.dt <= 0.0 {
            return Err(CheckpointError::new(&name("dt"), "is not positive"));
        }
        let with_history = body.after(&origin.history).grown(origin.growth);
        let map = StepMap { steadying: origin.steadying, ..map(origin.dt) };
        self.factorize(&with_history, &map, &origin.displacement, &origin.frame, origin.is_approximate)
            .map_err(|e| CheckpointError::new(&name("displacement"), e.to_string()))?;
        Ok(true)
    }

    /// Lets no step rely on the factor.
    pub fn forget(&mut self) {
        self.coefficients = None;
    }

    /// Makes the factor with the stiffness at `u`, where the frame of the body is `frame`.
    ///
    /// It may be `approximate` where that will do (see [`crate::body::Interval::approximates`]).
    ///
    /// A configuration under strong compression, or a guess on the way to one, may be where K̄ is indefinite. The stiffness of the
    /// reference configuration, turned, serves there: slower, but it never is.
    pub fn factorize(
        &mut self,
        with_history: &BodyWithHistory<'_, D>,
        map: &StepMap,
        u: &[Vector<D>],
        frame: &Matrix<D>,
        approximate: bool,
    ) -> Result<(), StepError> {
        self.factorize_at(with_history, map, u, frame, approximate).or_else(|_| {
            self.factorize_at(
                &with_history.body.after(&[]),
                map,
                &nodal::zeros(u.len()),
                &Matrix::identity(),
                approximate,
            )?;
            self.turn_to(frame);
            Ok::<(), StepError>(())
        })?;
        let Origin { displacement, history, growth, .. } = &mut self.origin;
        *growth = with_history.growth();
        displacement.copy_from_slice(u);
        history.copy_from_slice(with_history.history());
        (self.origin.dt, self.origin.steadying) = (map.dt, map.steadying);
        (self.origin.is_approximate, self.origin.frame) = (approximate, *frame);
        Ok(())
    }

    /// Names the nodes, ascending, that contacts act on with factors made from now on.
    pub fn expect_contacts(&mut self, nodes: &[u32]) {
        self.inverse.expect(nodes);
    }

    /// How many iterations with a kept tangent a new one is worth.
    pub fn worth(&self) -> i32 {
        if self.inverse.is_large() { WORTH[1] } else { WORTH[0] }
    }

    /// See [`crate::body::Body::hides_softness`].
    pub fn hides_softness(&self) -> bool {
        self.is_loose && !self.inverse.is_large()
    }

    /// What holds corrections of a load step back [1/s²], where this share of the inertia of the lowest motion is to, and so much is left of what
    /// holds a loose body.
    pub fn inertia(&self, held_back: f64, grip: f64) -> f64 {
        let share = if self.is_loose { held_back.max(LOOSE * grip) } else { held_back };
        share * self.lowest_inertia
    }

    /// Makes the factor of a tangent of a load step at displacements `u` [m], from the `stiffness` of the body and its loads, or says that it is
    /// indefinite.
    pub fn linearise(
        &mut self,
        body: &Body<D>,
        mut stiffness: NodalMatrix<Matrix<D>>,
        u: &[Vector<D>],
        tangent: &Tangent<'_, D>,
    ) -> Result<(), StepError> {
        let mut inertia = self.inertia(tangent.held_back, tangent.grip);
        if tangent.held_back == 0.0 && tangent.softest_spring > 0.0 {
            inertia = inertia.min(BESIDE_SPRINGS * tangent.softest_spring / body.total_mass());
        }
        self.support(body, &mut stiffness, tangent.springs, inertia);
        self.invert(body, stiffness, u, tangent.is_first)
    }

    /// The same of a step in time by `map`, whose own inertia holds back, too.
    pub fn linearise_in_time(
        &mut self,
        with_history: &BodyWithHistory<'_, D>,
        map: &StepMap,
        u: &[Vector<D>],
        frame: &Matrix<D>,
        tangent: &Tangent<'_, D>,
    ) -> Result<(), StepError> {
        let mut stiffness = Self::stiffness_of_step(with_history, map, u, frame);
        let held_back = tangent.held_back * self.lowest_inertia;
        self.support(with_history.body, &mut stiffness, tangent.springs, held_back);
        self.invert(with_history.body, stiffness, u, false)
    }

    /// Adds springs to the ground and an inertia [1/s²] to a stiffness.
    fn support(
        &self,
        body: &Body<D>,
        stiffness: &mut NodalMatrix<Matrix<D>>,
        springs: &[(u32, Matrix<D>)],
        inertia: f64,
    ) {
        for &(n, block) in springs {
            if is_counted(body) {
                let own = stiffness.graph().entry(n, n);
                stiffness.values[own] += block;
            }
        }
        for (k, m) in stiffness.values.iter_mut().zip(&body.mass().values) {
            *k += Matrix::from_diagonal_element(m * inertia);
        }
    }

    /// Makes the exact factor of a tangent at displacements `u` [m], on which no other step may rely.
    fn invert(
        &mut self,
        body: &Body<D>,
        mut stiffness: NodalMatrix<Matrix<D>>,
        u: &[Vector<D>],
        economical: bool,
    ) -> Result<(), StepError> {
        self.coefficients = None;
        self.note_noise(body, u, &stiffness);
        if let Some(ranks) = body.ranks() {
            ranks.sum(bytemuck::cast_slice_mut(&mut self.scratch));
        }
        self.held.uncouple(&mut stiffness);
        self.inverse.make_exact(economical, &stiffness)?;
        self.held.clear(&mut self.scratch);
        self.inverse.begin(&mut self.scratch);
        self.inverse.end(&mut self.scratch);
        self.round_off = nodal::largest(&self.scratch);
        self.factor_frame = Matrix::identity();
        self.turn = Matrix::identity();
        self.light.leave();
        self.generation += 1;
        Ok(())
    }

    fn factorize_at(
        &mut self,
        with_history: &BodyWithHistory<'_, D>,
        map: &StepMap,
        u: &[Vector<D>],
        frame: &Matrix<D>,
        approximate: bool,
    ) -> Result<(), StepError> {
        let mut stiffness = Self::stiffness_of_step(with_history, map, u, frame);
        self.coefficients = None;
        self.held.uncouple(&mut stiffness);
        // Where nodes have no mass, something else than mass resists a translation: a factor in single precision would change momentum.
        let has_digits = !approximate || !with_history.body.massless().is_empty();
        let precision = if has_digits { Precision::Double } else { Precision::Single };
        self.inverse.make(precision, approximate, &stiffness)?;
        let coefficients = Self::coefficients(map);
        let [_, c, m, _] = coefficients;
        self.coefficients = Some(coefficients);
        let mass_coefficient = m + c * with_history.body.damping().mass;
        self.translation.iter_mut().for_each(|t| t.coefficient = mass_coefficient);
        self.light.fit(map, with_history.body.damping().stiffness);
        self.factor_frame = *frame;
        self.turn = Matrix::identity();
        self.generation += 1;
        Ok(())
    }

    /// ξ K + ξ/(θΔt) C + M/(θΔt²) at displacements `u` [m] of a body with this `frame`.
    fn stiffness_of_step(
        with_history: &BodyWithHistory<'_, D>,
        map: &StepMap,
        u: &[Vector<D>],
        frame: &Matrix<D>,
    ) -> NodalMatrix<Matrix<D>> {
        let body = with_history.body;
        let mut stiffness = with_history.stiffness(u);
        let [k, c, m, _] = Self::coefficients(map);
        for (n, resistance) in steadied(body, map).filter(|_| is_counted(body)) {
            let own = stiffness.graph().entry(n as u32, n as u32);
            stiffness.values[own] += Matrix::from_diagonal_element(resistance);
        }
        let damping = body.damping();
        let mass_coefficient = m + c * damping.mass;
        let mass: &NodalMatrix<f64> = body.mass();
        let damping_stiffness = body.damping_stiffness();
        // The force of viscosity is that of the mean rate of the step, d/Δt, whatever the scheme.
        let viscosity = body.viscosity(u);
        for (entry, block) in stiffness.values.iter_mut().enumerate() {
            *block *= k;
            *block += Matrix::from_diagonal_element(mass.values[entry] * mass_coefficient);
            if let Some(k0) = damping_stiffness {
                *block += frame * k0.values[entry] * frame.transpose() * c;
            }
            if let Some(viscosity) = &viscosity {
                *block += viscosity.values[entry] / map.dt;
            }
        }
        stiffness
    }

    /// Writes the round-off of the internal forces on nodes to the scratch [N]. A deformation gradient is of the order of 1 + |u|/h, so that
    /// stresses are known to ε E (1 + |u|/h) and the force on a node to ε K_nn (h + |u|), h the distance of nodes.
    fn note_noise(&mut self, body: &Body<D>, u: &[Vector<D>], stiffness: &NodalMatrix<Matrix<D>>) {
        let spacing = body.mesh().diameter() / (body.node_count() as f64).powf(1.0 / D as f64);
        for (n, (noise, u)) in self.scratch.iter_mut().zip(u).enumerate() {
            let own = stiffness.values[stiffness.graph().entry(n as u32, n as u32)];
            let size = f64::EPSILON * (spacing + u.amax());
            *noise = Vector::from_fn(|i, _| sign(n * D + i) * own[(i, i)].abs() * size);
        }
    }

    /// Follows the body, whose frame is now `frame`.
    pub fn turn_to(&mut self, frame: &Matrix<D>) {
        if self.held.is_empty() {
            self.turn = frame * self.factor_frame.transpose();
        }
    }

    /// The rotation of the body since the factor was made.
    pub fn turn(&self) -> &Matrix<D> {
        &self.turn
    }

    /// Starts on K̄⁻¹ x: what [`Self::end`] will give can be seen, and `x` added to, at the nodes of [`Self::set_reach`].
    pub fn begin(&mut self, x: &[Vector<D>]) {
        let turn = &self.turn;
        nodal::each(&mut self.scratch, [x], |s, [x]| *s = turn.tr_mul(x));
        self.light.scale(&mut self.scratch);
        self.held.clear(&mut self.scratch);
        if let Some(translation) = &mut self.translation {
            translation.resultant = nodal::total(&self.scratch);
        }
        self.inverse.begin(&mut self.scratch);
    }

    /// Writes K̄⁻¹ x for the `x` that was begun with, and what was added to it, to `out`; zero where displacements are held.
    pub fn end(&mut self, out: &mut [Vector<D>]) {
        self.inverse.end(&mut self.scratch);
        let missing = match (&self.translation, self.inverse.precision()) {
            (Some(translation), Precision::Single) => translation.missing(&self.scratch),
            _ => Vector::zeros(),
        };
        let turn = &self.turn;
        nodal::each(out, [&self.scratch], |out, [s]| *out = turn * (s + missing));
    }

    /// Names the nodes of [`Self::seen`] and [`Self::add`].
    pub fn set_reach(&mut self, nodes: impl Iterator<Item = usize>) {
        self.inverse.set_reach(nodes);
    }

    /// Solves at the nodes of the reach, for [`Self::seen`].
    pub fn look(&mut self) {
        self.inverse.look();
    }

    /// K̄⁻¹ x at a node of the reach, as it was at the last look.
    pub fn seen(&self, node: usize) -> Vector<D> {
        self.turn * self.inverse.seen(node)
    }

    /// Adds `forces`, each at a node of the reach, to `x`.
    pub fn add(&mut self, forces: impl Iterator<Item = (usize, Vector<D>)>) {
        let Self { inverse, turn, held, translation, light, .. } = self;
        inverse.add(forces.map(|(node, force)| {
            let force = held.free_part(node, &turn.tr_mul(&force)) * light.share_of(node);
            translation.iter_mut().for_each(|t| t.resultant += force);
            (node, force)
        }));
    }

    /// Solves for unit forces at no more nodes of the reach than [`Inverse::AT_ONCE`]: see [`Self::response`]. Nodes near each other in the [`Self::order`]
    /// cost least.
    pub fn respond(&mut self, nodes: impl Iterator<Item = usize>) {
        self.inverse.respond(nodes);
    }

    /// The block (K̄⁻¹)_ab in the frame of the factor for any node a of the reach and one of these nodes b, named by its number among them, too.
    /// Where displacements are held a force moves nothing.
    pub fn response(&self, a: usize, (number, b): (usize, usize)) -> Matrix<D> {
        let mut block = self.inverse.response(number, a) * self.light.share_of(b);
        for component in (0..D).filter(|&component| self.held.holds(b, component)) {
            block.set_column(component, &Vector::zeros());
        }
        block
    }

    /// When a node is eliminated.
    pub fn order(&self, node: usize) -> usize {
        self.inverse.order(node)
    }

    /// Memory of the factor [bytes].
    pub fn bytes(&self) -> usize {
        self.inverse.bytes()
    }
}
