//! Mortar rows: contact in the mean over the surface instead of at its nodes (Puso & Laursen, Comput. Methods Appl. Mech. Engrg.
//! 193, 2004).
//!
//! Every source node A has a multiplier Φ_A, and its row is that of a weighted motion,
//!
//! ```text
//! w_A = frame_A · [Σ_B ∫Φ_A N_B dΓ d_B − Σ_C ∫Φ_A N_C dΓ d_C] / ∫Φ_A dΓ,     n_A ∥ −∫Φ_A n dΓ,
//! ```
//!
//! over the part of the source that the target covers, with n the outward normal of the source. Its gap is the same sum of
//! positions, along n_A. The rows have the form of those of nodes, so the reduced problem and its solvers know no difference. A
//! reaction is a force [N], spread by the same weights, and r_n/∫Φ_A (and the thickness) is the pressure at the node.
//!
//! **A multiplier on every side of a corner.** Where the source has a corner or a sharp edge, facets around a node look different ways, and the
//! target may lie before some of them alone. One multiplier would be a mean of two duties, and leap as facets of the second come
//! to face the target. So a node has a multiplier for every side of it (`sides.rs`), whose Φ_A ends at the edge.
//!
//! **Standard, not dual multipliers.** Φ_A is the linear shape function of the node, on quadratic facets that of their parts. It is
//! nowhere negative: the gap is a mean, p ≥ 0 holds everywhere and not at nodes only.
//!
//! Dual functions (Popp, Gitterle, Gee & Wall, Int. J. Numer. Meth. Engng 83, 2010) make ∫Φ_A N_B diagonal, which pays where
//! multipliers are condensed out of the global matrix. Here they never enter one. Where the target covers a facet only in part,
//! dual functions would have to be made anew from a mass matrix that degenerates with the part (Cichosz & Bischoff 2011). Standard
//! functions are simply integrated over what is covered, so that a uniform pressure is exact whichever side reaches beyond the
//! other.

mod clip;
mod facing;
mod integrate;
mod plane;
mod quadrature;
mod row;
mod share;

use std::ops::Range;

use self::facing::Facing;
use self::integrate::integrate;
use self::row::Row;
use crate::path::Positions;
use crate::{Candidate, Contact, ContactModel, Discretisation, Extents, Path, Site, Target};

/// The node of a multiplier and the side of it that it is on.
pub(crate) type Multiplier = (u32, u32);

/// What the mortar pairs of a model have found in a step, and scratch. It may be dropped at any moment between two steps.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mortar<const D: usize> {
    /// Facets that may face one another, ascending.
    facing: Vec<Facing>,
    /// The rows of the candidates where they were found: of one that the target leaves within the step, the last there is.
    found: Vec<(Candidate, Contact<D>)>,
    rows: Vec<Row<D>>,
    /// The multipliers that the rows are of.
    multipliers: Vec<Multiplier>,
    pairs: Vec<usize>,
}

impl<const D: usize> ContactModel<D> {
    /// Finds the multipliers of mortar pairs whose gap comes within the margin of the `path` and adds them to the candidates `out`.
    ///
    /// A multiplier counts where the target covers it at the predicted middle of the step or at its end.
    pub fn detect_mortar(&self, path: &Path<'_, D>, mortar: &mut Mortar<D>, out: &mut Vec<Candidate>) {
        mortar.facing.clear();
        mortar.found.clear();
        let (middle, end) = (|n: u32| path.middle(n), path.end);
        let mut pairs = std::mem::take(&mut mortar.pairs);
        self.mortar_pairs(path, &mut pairs);
        for &pair in &pairs {
            let first = mortar.facing.len();
            self.find_facing(pair, path, &mut mortar.facing);
            let surface = &self.surfaces[self.pairs.get(pair).source];
            let mut multipliers = std::mem::take(&mut mortar.multipliers);
            multipliers.clear();
            for facing in mortar.facing[first..].chunk_by(|a, b| a.source == b.source) {
                let f = facing[0].source;
                let nodes = surface.facets[f as usize].nodes.iter().enumerate();
                multipliers.extend(nodes.map(|(a, &node)| (node, surface.side(f, a))));
            }
            multipliers.sort_unstable();
            multipliers.dedup();
            multipliers.retain(|(n, _)| surface.sources.binary_search(n).is_ok());
            let candidate = |&multiplier: &Multiplier| Candidate::of_multiplier(pair as u32, multiplier);
            let first = mortar.found.len();
            self.integrate_rows(pair, &multipliers, &middle, mortar);
            for (multiplier, row) in multipliers.iter().zip(&mortar.rows) {
                let contact = row.contact(&middle).filter(|c| c.gap <= path.margin);
                mortar.found.extend(contact.map(|c| (candidate(multiplier), c)));
            }
            let known = mortar.found.len();
            self.integrate_rows(pair, &multipliers, end, mortar);
            for (multiplier, row) in multipliers.iter().zip(&mortar.rows) {
                let (known, candidate) = (&mortar.found[first..known], candidate(multiplier));
                let is_new = known.binary_search_by_key(&candidate.site, |(c, _)| c.site).is_err();
                let contact = row.contact(end).filter(|c| is_new && c.gap <= path.margin);
                mortar.found.extend(contact.map(|c| (candidate, c)));
            }
            mortar.found[first..].sort_unstable_by_key(|(c, _)| *c);
            mortar.multipliers = multipliers;
        }
        mortar.pairs = pairs;
        if !mortar.found.is_empty() {
            out.extend(mortar.found.iter().map(|(c, _)| *c));
            out.sort_unstable();
        }
    }

    /// Writes gap, frame and stencil of every candidate, ascending, to `out`, where the nodes are at `position`.
    pub fn evaluate_all(
        &self,
        candidates: &[Candidate],
        position: &Positions<'_, D>,
        mortar: &mut Mortar<D>,
        out: &mut Vec<Contact<D>>,
    ) {
        out.clear();
        self.evaluate_more(candidates, position, mortar, out);
    }

    /// The same after what is in `out`.
    pub fn evaluate_more(
        &self,
        candidates: &[Candidate],
        position: &Positions<'_, D>,
        mortar: &mut Mortar<D>,
        out: &mut Vec<Contact<D>>,
    ) {
        for of_pair in candidates.chunk_by(|a, b| a.pair == b.pair) {
            let pair = of_pair[0].pair as usize;
            if !self.is_mortar(pair) {
                out.extend(of_pair.iter().map(|c| self.evaluate(c, position)));
                continue;
            }
            let mut multipliers = std::mem::take(&mut mortar.multipliers);
            multipliers.clear();
            multipliers.extend(of_pair.iter().map_while(|c| match c.site {
                Site::Multiplier(node, side) => Some((node, side)),
                _ => None,
            }));
            self.integrate_rows(pair, &multipliers, position, mortar);
            let (of_multipliers, crossings) = of_pair.split_at(multipliers.len());
            mortar.multipliers = multipliers;
            for (candidate, row) in of_multipliers.iter().zip(&mortar.rows) {
                let contact =
                    row.contact(position).or_else(|| Some(mortar.found(candidate)?.moved(position)));
                out.push(contact.unwrap_or_else(|| self.evaluate(candidate, position)));
            }
            out.extend(crossings.iter().map(|c| self.evaluate(c, position)));
        }
    }

    /// The contact of a single multiplier, integrated over all that faces it at this `position`. Of one that the target does not cover it is that
    /// of its node.
    pub(crate) fn multiplier(
        &self,
        pair: usize,
        (node, side): Multiplier,
        position: &Positions<'_, D>,
    ) -> Contact<D> {
        let mut mortar = Mortar::default();
        let nearest = self.before_nearest(pair, node, position);
        let margin = nearest.relative(|n| position(n as u32)).norm();
        self.find_facing(pair, &Path::resting(position, margin), &mut mortar.facing);
        self.integrate_rows(pair, &[(node, side)], position, &mut mortar);
        mortar.rows[0].contact(position).unwrap_or(nearest)
    }

    /// Whether the rows of a pair are those of multipliers.
    #[must_use]
    pub fn is_mortar(&self, pair: usize) -> bool {
        let pair = self.pairs.get(pair);
        let has_facets = |target: Target| match target {
            Target::Surface(t) => !self.surfaces[t].facets.is_empty(),
            Target::Obstacle(_) => false,
        };
        pair.discretisation == Discretisation::Mortar && has_facets(pair.target)
    }

    /// Writes to `pairs` the mortar pairs, ascending, that may come within the margin of a `path`.
    fn mortar_pairs(&self, path: &Path<'_, D>, pairs: &mut Vec<usize>) {
        pairs.clear();
        if self.pairs.have_mortar() {
            let way = if self.pairs.are_many() {
                self.extents(path.start).union(&self.extents(path.end))
            } else {
                Extents::default()
            };
            self.within(2.0 * path.margin, &way, pairs);
            pairs.retain(|&p| self.is_mortar(p));
        }
    }

    /// Fills `mortar.rows`, one for each of `multipliers`, which ascend.
    fn integrate_rows(
        &self,
        pair: usize,
        multipliers: &[Multiplier],
        position: &Positions<'_, D>,
        mortar: &mut Mortar<D>,
    ) {
        let Target::Surface(target) = self.pairs.get(pair).target else { return };
        let (source, target) = (&self.surfaces[self.pairs.get(pair).source], &self.surfaces[target]);
        mortar.rows.resize_with(multipliers.len(), Row::default);
        mortar.rows.iter_mut().for_each(Row::clear);
        for facing in mortar.facing[mortar.of_pair(pair)].chunk_by(|a, b| a.source == b.source) {
            let f = facing[0].source;
            let nodes = &source.facets[f as usize].nodes;
            let row_of = |a: usize| multipliers.binary_search(&(nodes[a], source.side(f, a))).ok();
            if (0..nodes.len()).any(|a| row_of(a).is_some()) {
                let targets = facing.iter().map(|f| f.target);
                let rows = &mut mortar.rows;
                integrate([source, target], f, targets, position, &row_of, rows);
            }
        }
    }
}

impl<const D: usize> Mortar<D> {
    /// A candidate where it was found; none if it was not found here.
    fn found(&self, candidate: &Candidate) -> Option<&Contact<D>> {
        let found = self.found.binary_search_by_key(&candidate.key(), |(c, _)| c.key());
        found.ok().map(|k| &self.found[k].1)
    }

    /// The facing facets of a pair.
    fn of_pair(&self, pair: usize) -> Range<usize> {
        let start = self.facing.partition_point(|f| (f.pair as usize) < pair);
        start..self.facing.partition_point(|f| f.pair as usize <= pair)
    }
}
