//! The smallest gap of all pairs.

use crate::aabb::Aabb;
use crate::bvh::{self, Bvh};
use crate::distance::signed_distance_within;
use crate::path::Positions;
use crate::{ContactModel, Extents, Pair, Target};

/// What is known of the gaps of all pairs before they are asked for.
#[derive(Debug, Clone, Copy)]
pub struct KnownGaps<'a, F> {
    /// What every pair may have: gaps count beyond it [m].
    pub least: F,
    /// The largest of these [m].
    pub most: f64,
    /// A gap that there is, beyond what its pair may have [m]; infinite if none is known.
    pub known: f64,
    /// No node is deeper inside a target than this [m]; infinite if that is not known.
    pub deepest: f64,
    /// The only nodes that may be inside of a target that is a surface, each with its pair, ascending by pairs; none if it may be any.
    pub suspects: Option<&'a [(u32, u32)]>,
}

impl<F> KnownGaps<'_, F> {
    /// Those of a pair.
    fn suspects_of(&self, pair: usize) -> Option<&[(u32, u32)]> {
        let all = self.suspects?;
        let from = all.partition_point(|&(p, _)| (p as usize) < pair);
        let until = all.partition_point(|&(p, _)| (p as usize) <= pair);
        Some(&all[from..until])
    }
}

/// What a measure of gaps keeps from one call to the next. It may be dropped at any moment.
#[derive(Debug, Clone, Default)]
pub struct Gauge<const D: usize> {
    extents: Extents<D>,
    sides: Vec<Facets<D>>,
    pairs: Vec<usize>,
}

/// The facets of a surface.
#[derive(Debug, Clone)]
struct Facets<const D: usize> {
    boxes: Vec<Aabb<D>>,
    /// The box around all.
    whole: Aabb<D>,
    tree: Bvh<D>,
    is_fitted: bool,
}

impl<const D: usize> Default for Facets<D> {
    fn default() -> Self {
        Self { boxes: Vec::new(), whole: Aabb::of([]), tree: Bvh::new([].into_iter()), is_fitted: false }
    }
}

impl<const D: usize> Gauge<D> {
    /// The smallest gap of all pairs of two solids beyond the least that each may have [m], where the nodes are at `position`, or the known one if that is smaller;
    /// infinite without a pair.
    #[must_use]
    pub fn smallest_gap<F: Fn(&Pair) -> f64>(
        &mut self,
        model: &ContactModel<D>,
        gaps: &KnownGaps<'_, F>,
        position: &Positions<'_, D>,
    ) -> f64 {
        self.place(model, position);
        let surfaces = &self.extents.surfaces;
        let all = surfaces.iter().fold(Aabb::of([]), |all, own| all.union(own));
        // Neighbours are no farther apart than they are large, as a rule.
        let size = surfaces.iter().map(Aabb::diameter).fold(f64::INFINITY, f64::min);
        let mut reach = (gaps.known + gaps.most).max(0.0).min(size);
        loop {
            let mut pairs = std::mem::take(&mut self.pairs);
            model.within(reach, &self.extents, &mut pairs);
            // A surface is no distance away from itself.
            pairs.retain(|&p| !model.is_self_contact(p));
            let smallest = self.smallest_among(&pairs, model, gaps, position);
            self.pairs = pairs;
            if !model.pairs.are_many() || smallest + gaps.most <= reach || reach > all.diameter() {
                return smallest;
            }
            reach = if smallest.is_finite() { smallest + gaps.most } else { 2.0 * reach.max(gaps.most) };
        }
    }

    /// Boxes around all facets and surfaces.
    fn place(&mut self, model: &ContactModel<D>, position: &Positions<'_, D>) {
        let Self { extents, sides, .. } = self;
        sides.resize_with(model.surfaces.len(), Facets::default);
        extents.surfaces.clear();
        for (side, surface) in sides.iter_mut().zip(&model.surfaces) {
            side.is_fitted = false;
            side.boxes.clear();
            side.boxes.extend((0..surface.facets.len() as u32).map(|f| surface.bounds(f, position)));
            side.whole = side.boxes.iter().fold(Aabb::of([]), |all, facet| all.union(facet));
            let sources = Aabb::of(surface.sources.iter().map(|&n| position(n)));
            extents.surfaces.push(side.whole.union(&sources).union(&surface.round_box(position)));
        }
    }

    /// The same of some `pairs`.
    fn smallest_among<F: Fn(&Pair) -> f64>(
        &mut self,
        pairs: &[usize],
        model: &ContactModel<D>,
        gaps: &KnownGaps<'_, F>,
        position: &Positions<'_, D>,
    ) -> f64 {
        let pairs = || pairs.iter().map(|&p| (p, model.pairs.get(p)));
        let bound = |extents: &Extents<D>, pair: &Pair| {
            let least = (gaps.least)(pair);
            (model.at_least(pair, extents, position).max(-gaps.deepest) - least, least)
        };
        let mut smallest = gaps.known;
        if smallest == f64::INFINITY {
            let nearest = pairs().map(|(p, pair)| (bound(&self.extents, &pair), (p, pair)));
            if let Some(((_, least), (p, pair))) = nearest.min_by(|a, b| a.0.0.total_cmp(&b.0.0)) {
                let any = KnownGaps {
                    least: &gaps.least,
                    most: gaps.most,
                    known: gaps.known,
                    deepest: f64::INFINITY,
                    suspects: None,
                };
                smallest = self.gap_within(f64::INFINITY, (p, &pair), model, &any, position) - least;
            }
        }
        for (p, pair) in pairs() {
            let (at_least, least) = bound(&self.extents, &pair);
            // Only a gap below the smallest so far is asked for.
            if at_least < smallest {
                let gap = self.gap_within(smallest + least, (p, &pair), model, gaps, position);
                smallest = smallest.min(gap - least);
            }
        }
        smallest
    }

    /// The smallest distance of a source of a pair from its target, negative inside, if it is below `reach` [m]; otherwise it may come out larger, also
    /// infinite.
    fn gap_within<F>(
        &mut self,
        reach: f64,
        (number, pair): (usize, &Pair),
        model: &ContactModel<D>,
        gaps: &KnownGaps<'_, F>,
        position: &Positions<'_, D>,
    ) -> f64 {
        if let Some(round) = model.round_proximity(pair, position) {
            return round.gap;
        }
        let sources = &model.surfaces[pair.source].sources;
        match pair.target {
            Target::Obstacle(o) => {
                let points = sources.iter().map(|&n| position(n));
                points.map(|x| model.obstacles[o].gap(&x, position).0).fold(f64::INFINITY, f64::min)
            }
            Target::Surface(t) => {
                let (side, surface) = (&mut self.sides[t], &model.surfaces[t]);
                let suspects = gaps.suspects_of(number);
                let mut smallest = reach;
                for &node in sources {
                    let x = position(node);
                    let distance = side.whole.distance(&x);
                    if distance > smallest.max(0.0) {
                        continue;
                    }
                    let is_suspect = suspects.is_none_or(|some| some.iter().any(|&(_, n)| n == node));
                    if !is_suspect && smallest <= 0.0 {
                        continue;
                    }
                    if !side.is_fitted {
                        bvh::fit(&mut side.tree, side.boxes.len(), |f| side.boxes[f as usize]);
                        side.is_fitted = true;
                    }
                    // Outside of the box of the target nothing is behind a facet: what is farther than the smallest so far has no say.
                    let may_be_inside = is_suspect && distance <= 0.0;
                    let reach = if may_be_inside { smallest.max(gaps.deepest) } else { smallest };
                    let gap = signed_distance_within(reach, &x, surface, &side.tree, position);
                    // What is known to be outside is not inside by round-off, whose sign is that of the facet met first.
                    smallest = smallest.min(if is_suspect { gap } else { gap.abs() });
                }
                smallest
            }
        }
    }
}
