//! The state.

use carom_contact::{Contact, Site, Target};
use carom_mesh::{Matrix, Vector};

use crate::archive::{Archive, CheckpointError};
use crate::{Assembly, Reaction, SlidingRecord, State};

/// Records or replays the state.
pub(super) fn exchange<const D: usize>(
    archive: &mut Archive<'_>,
    assembly: &Assembly<D>,
    state: &mut State<D>,
) -> Result<(), CheckpointError> {
    archive.numbers("state/time", [&mut state.time])?;
    archive.vectors("state/displacement", &mut state.displacement)?;
    archive.vectors("state/velocity", &mut state.velocity)?;
    archive.vectors("state/contact_force", &mut state.contact_force)?;
    archive.numbers("state/friction_energy", &mut state.friction_energy)?;
    archive.vectors("state/support", &mut state.support)?;
    archive.vectors("state/anchor", &mut state.anchor)?;
    archive.numbers("state/slip", &mut state.slip)?;
    archive.vectors("state/internal_force", &mut state.internal_force)?;
    archive.numbers("state/energies", state.energies.terms_mut())?;
    archive.numbers("state/body_energies", state.body_energies.iter_mut().flat_map(|e| e.terms_mut()))?;
    archive.numbers("state/energy_debt", &mut state.energy_debt)?;
    sliding(archive, assembly, &mut state.sliding)?;
    archive.plastic("state/plastic", state.history.iter_mut().flatten())?;
    let mut reactions = Reactions::of(&state.reactions);
    reactions.exchange(archive)?;
    if archive.replays() {
        state.reactions = reactions.into_reactions(assembly)?;
    }
    Ok(())
}

/// What contacts remember of their sliding.
fn sliding<const D: usize>(
    archive: &mut Archive<'_>,
    assembly: &Assembly<D>,
    records: &mut Vec<SlidingRecord<D>>,
) -> Result<(), CheckpointError> {
    let count = archive.rows("state/sliding/pair", records.len())?;
    let mut sites: Vec<[u32; 4]> = records.iter().map(|r| to_nodes(r.site)).collect();
    sites.resize(count, [0; 4]);
    records.resize(count, SlidingRecord::new((0, Site::Node(0)), 0.0));
    archive.integers("state/sliding/pair", records.iter_mut().map(|r| &mut r.pair))?;
    archive.integers("state/sliding/site", sites.as_flattened_mut())?;
    archive.numbers("state/sliding/distance", records.iter_mut().map(|r| &mut r.distance))?;
    archive.numbers("state/sliding/state", records.iter_mut().map(|r| &mut r.state))?;
    archive.numbers("state/sliding/direction", records.iter_mut().flat_map(|r| r.direction.iter_mut()))?;
    if !archive.replays() {
        return Ok(());
    }
    for (record, site) in records.iter_mut().zip(sites) {
        if assembly.contact.pairs.find(record.pair as usize).is_none() {
            return Err(CheckpointError::new("state/sliding/pair", "names a pair that is not there"));
        }
        let site = to_site(assembly, record.pair, site);
        record.site =
            site.ok_or_else(|| CheckpointError::new("state/sliding/site", "names a node that is not there"))?;
    }
    if records.is_sorted_by_key(SlidingRecord::key) {
        return Ok(());
    }
    Err(CheckpointError::new("state/sliding/site", "is not ascending"))
}

/// Reactions as arrays: one entry or vector per reaction, and stencils one after the other.
#[derive(Default)]
struct Reactions<const D: usize> {
    pair: Vec<u32>,
    /// As of [`to_nodes`].
    site: Vec<[u32; 4]>,
    /// `u32::MAX` for none.
    facet: Vec<u32>,
    force: Vec<Vector<D>>,
    /// Negative for none.
    adhesion: Vec<f64>,
    gap: Vec<f64>,
    offset: Vec<f64>,
    area: Vec<f64>,
    frame: Vec<Matrix<D>>,
    source_count: Vec<usize>,
    stencil_length: Vec<usize>,
    stencil_node: Vec<u32>,
    stencil_weight: Vec<f64>,
}

const PREFIX: &str = "state/reactions";

/// A site as four numbers: the nodes of two edges, or one node or corner four times; of a multiplier its node twice, its side, and none; of
/// a point between nodes these, its number, and none; of what is before a round obstacle the nodes of an edge, or the number of a facet twice, and twice
/// none; of a node before a second facet that, and three times none.
fn to_nodes(site: Site) -> [u32; 4] {
    match site {
        Site::Node(n) | Site::Corner(n) => [n; 4],
        Site::Multiplier(n, side) => [n, n, side, u32::MAX],
        Site::Crossing([a, b], [c, d]) => [a, b, c, d],
        Site::Facet(f) => [f, f, u32::MAX, u32::MAX],
        Site::Edge([a, b]) => [a, b, u32::MAX, u32::MAX],
        Site::Between([a, b], point) => [a, b, point, u32::MAX],
        Site::Second(n) => [n, u32::MAX, u32::MAX, u32::MAX],
    }
}

/// The site of [`to_nodes`] in a pair, if it can be one. No edge begins where it ends, and corners are numbered after all nodes.
fn to_site<const D: usize>(assembly: &Assembly<D>, pair: u32, [a, b, c, d]: [u32; 4]) -> Option<Site> {
    let contact = &assembly.contact;
    let is_node = |n: &u32| (*n as usize) < assembly.node_count();
    let is_corner = |n: &u32| match contact.pairs.get(pair as usize).target {
        Target::Obstacle(o) => contact.obstacles[o].has_corner(*n),
        Target::Surface(_) => false,
    };
    if [b, c, d] == [u32::MAX; 3] {
        return is_node(&a).then_some(Site::Second(a));
    }
    if [c, d] == [u32::MAX; 2] {
        let site = if a == b { Site::Facet(a) } else { Site::Edge([a, b]) };
        return contact.has_between_nodes(pair as usize, site).then_some(site);
    }
    if d == u32::MAX {
        let site = Site::Between([a, b], c);
        return match a == b {
            true => is_node(&a).then_some(Site::Multiplier(a, c)),
            false => contact.has_between_nodes(pair as usize, site).then_some(site),
        };
    }
    if a != b {
        let is_crossing = [a, b].iter().all(is_node) && [c, d].iter().all(|n| is_node(n) || is_corner(n));
        return is_crossing.then_some(Site::Crossing([a, b], [c, d]));
    }
    if is_node(&a) { Some(Site::Node(a)) } else { is_corner(&a).then_some(Site::Corner(a)) }
}

impl<const D: usize> Reactions<D> {
    fn of(reactions: &[Reaction<D>]) -> Self {
        let contacts = || reactions.iter().map(|r| &r.contact);
        let stencils = || contacts().flat_map(Contact::stencil);
        Self {
            pair: reactions.iter().map(|r| r.pair).collect(),
            site: reactions.iter().map(|r| to_nodes(r.site)).collect(),
            facet: reactions.iter().map(|r| r.facet.unwrap_or(u32::MAX)).collect(),
            force: reactions.iter().map(|r| r.force).collect(),
            adhesion: reactions.iter().map(|r| r.adhesion.unwrap_or(-1.0)).collect(),
            gap: contacts().map(|c| c.gap).collect(),
            offset: contacts().map(Contact::offset).collect(),
            area: contacts().map(|c| c.area).collect(),
            frame: contacts().map(|c| c.frame).collect(),
            source_count: contacts().map(|c| c.sources().len()).collect(),
            stencil_length: contacts().map(|c| c.stencil().len()).collect(),
            stencil_node: stencils().map(|(node, _)| node as u32).collect(),
            stencil_weight: stencils().map(|(_, weight)| weight).collect(),
        }
    }

    fn exchange(&mut self, archive: &mut Archive<'_>) -> Result<(), CheckpointError> {
        let name = |of: &str| format!("{PREFIX}/{of}");
        let count = archive.rows(&name("pair"), self.pair.len())?;
        let entries = archive.rows(&name("stencil_node"), self.stencil_node.len())?;
        self.pair.resize(count, 0);
        self.site.resize(count, [0; 4]);
        self.facet.resize(count, 0);
        self.force.resize(count, Vector::zeros());
        self.adhesion.resize(count, -1.0);
        self.gap.resize(count, 0.0);
        self.offset.resize(count, 0.0);
        self.area.resize(count, 0.0);
        self.frame.resize(count, Matrix::zeros());
        self.source_count.resize(count, 0);
        self.stencil_length.resize(count, 0);
        self.stencil_node.resize(entries, 0);
        self.stencil_weight.resize(entries, 0.0);
        archive.integers(&name("pair"), &mut self.pair)?;
        archive.integers(&name("site"), self.site.as_flattened_mut())?;
        archive.integers(&name("facet"), &mut self.facet)?;
        archive.vectors(&name("force"), &mut self.force)?;
        archive.numbers(&name("adhesion"), &mut self.adhesion)?;
        archive.numbers(&name("gap"), &mut self.gap)?;
        archive.numbers(&name("offset"), &mut self.offset)?;
        archive.numbers(&name("area"), &mut self.area)?;
        archive.numbers(&name("frame"), self.frame.iter_mut().flat_map(|f| f.iter_mut()))?;
        archive.integers(&name("source_count"), &mut self.source_count)?;
        archive.integers(&name("stencil_length"), &mut self.stencil_length)?;
        archive.integers(&name("stencil_node"), &mut self.stencil_node)?;
        archive.numbers(&name("stencil_weight"), &mut self.stencil_weight)
    }

    fn into_reactions(self, assembly: &Assembly<D>) -> Result<Vec<Reaction<D>>, CheckpointError> {
        let wrong = |of: &str, what: &str| CheckpointError::new(&format!("{PREFIX}/{of}"), what);
        let all = |indices: &[u32], count: usize| indices.iter().all(|&i| (i as usize) < count);
        if self.pair.iter().any(|&p| assembly.contact.pairs.find(p as usize).is_none()) {
            return Err(wrong("pair", "names a pair that is not there"));
        }
        if !all(&self.stencil_node, assembly.reference.len()) {
            return Err(wrong("stencil_node", "names a node that is not there"));
        }
        let entries = self.stencil_length.iter().try_fold(0_usize, |sum, &n| sum.checked_add(n));
        let is_split =
            self.source_count.iter().zip(&self.stencil_length).all(|(sources, all)| sources <= all);
        if entries != Some(self.stencil_node.len()) || !is_split {
            return Err(wrong("stencil_length", "does not fit the stencils"));
        }
        let mut stencils = self.stencil_node.into_iter().zip(self.stencil_weight);
        let mut reactions = Vec::with_capacity(self.pair.len());
        for k in 0..self.pair.len() {
            let stencil = stencils.by_ref().take(self.stencil_length[k]);
            let contact =
                Contact::of_stencil(self.gap[k], self.frame[k], self.area[k], stencil, self.source_count[k])
                    .with_offset(self.offset[k]);
            let pair = self.pair[k];
            let site = to_site(assembly, pair, self.site[k]);
            let site = site.ok_or_else(|| wrong("site", "names a node that is not there"))?;
            let facet = Some(self.facet[k]).filter(|&f| f != u32::MAX);
            let adhesion = Some(self.adhesion[k]).filter(|a| *a >= 0.0);
            let reaction = Reaction { pair, site, facet, contact, force: self.force[k], adhesion };
            reactions.push(reaction);
        }
        if !reactions.is_sorted_by_key(Reaction::key) {
            return Err(wrong("site", "is not ascending"));
        }
        if !reactions.iter().all(|r| assembly.contact.has_facet(&r.candidate())) {
            return Err(wrong("facet", "names a facet that is not there"));
        }
        Ok(reactions)
    }
}
