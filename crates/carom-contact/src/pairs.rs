//! Who is checked against whom: a list of pairs or, where bodies are so many that their pairs cannot be listed, a rule.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::{Discretisation, Pair, Solid, Target};

/// Whose nodes are checked in a pair of two surfaces, of which one comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Directions {
    /// Those of the first.
    Forward,
    /// Those of the second.
    Backward,
    /// Those of both.
    Both,
    /// Those of the surface that is finer, of the first if they are alike.
    Finer,
}

/// What two solids are to one another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairRule {
    /// Friction coefficient.
    pub friction: f64,
    /// How contact between two surfaces is written.
    pub discretisation: Discretisation,
    /// Whose nodes are checked. Those of a body with itself or with an obstacle are always the body's.
    pub directions: Directions,
}

/// What the pairs of a surface depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Side {
    /// Whether its nodes are checked against its own facets.
    pub touches_itself: bool,
    /// Mean width of its facets [m].
    pub facet_width: f64,
    /// Mass of its body [kg]; zero where nobody knows it.
    pub mass: f64,
}

/// Widths and masses apart by no more than this part are alike: files of meshes in single precision lose as much.
const ALIKE: f64 = 1e-6;

impl Side {
    /// Whether the facets are on average smaller than those of another, or as large and the body is the lighter one.
    #[must_use]
    pub fn is_finer_than(&self, other: &Self) -> bool {
        let is_less = |x: f64, y: f64| x < (1.0 - ALIKE) * y;
        let [width, other_width] = [self.facet_width, other.facet_width];
        is_less(width, other_width) || !is_less(other_width, width) && is_less(self.mass, other.mass)
    }
}

/// One rule for all pairs, and the pairs for which another holds.
#[derive(Debug, Clone, PartialEq)]
pub struct PairRules {
    /// The surfaces.
    pub sides: Vec<Side>,
    /// Number of obstacles.
    pub obstacles: usize,
    /// What holds where nothing else is said.
    pub rule: PairRule,
    /// What holds for some solids instead, in ascending order; nothing for those that never touch.
    pub exceptions: BTreeMap<[Solid; 2], Option<PairRule>>,
}

impl PairRules {
    /// The rule for two solids in ascending order; none if they never touch.
    #[must_use]
    pub fn of(&self, between: [Solid; 2]) -> Option<PairRule> {
        match between {
            [Solid::Body(a), Solid::Body(b)] if a == b && !self.sides[a].touches_itself => return None,
            [Solid::Obstacle(_), _] => return None,
            _ => {}
        }
        self.exceptions.get(&between).copied().unwrap_or(Some(self.rule))
    }

    /// The pairs of two solids in ascending order: none, one or, if both sides are checked, two.
    fn pairs(&self, between: [Solid; 2]) -> [Option<Pair>; 2] {
        let Some(PairRule { friction, discretisation, directions }) = self.of(between) else {
            return [None; 2];
        };
        let node_by_node = Discretisation::NodeToSegment;
        let pair = |source, target, discretisation| Some(Pair { source, target, friction, discretisation });
        match between {
            [Solid::Body(a), Solid::Obstacle(o)] => [pair(a, Target::Obstacle(o), node_by_node), None],
            // Nodes of a body against its own facets: neither side is the source.
            [Solid::Body(a), Solid::Body(b)] if a == b => [pair(a, Target::Surface(a), node_by_node), None],
            [Solid::Body(a), Solid::Body(b)] => {
                let forward = || pair(a, Target::Surface(b), discretisation);
                let backward = || pair(b, Target::Surface(a), discretisation);
                match directions {
                    Directions::Forward => [forward(), None],
                    Directions::Backward => [None, backward()],
                    Directions::Both => [forward(), backward()],
                    Directions::Finer if self.sides[b].is_finer_than(&self.sides[a]) => [None, backward()],
                    Directions::Finer => [forward(), None],
                }
            }
            [Solid::Obstacle(_), _] => [None; 2],
        }
    }

    /// Those that a surface may be in a pair with as the first of the two: itself, surfaces after it and obstacles.
    fn seconds(&self, first: usize) -> impl Iterator<Item = Solid> + use<> {
        (first..self.sides.len()).map(Solid::Body).chain((0..self.obstacles).map(Solid::Obstacle))
    }

    /// Solids that a surface may be in a pair with, whether it comes first or not.
    fn width(&self) -> usize {
        self.sides.len() + self.obstacles
    }

    /// Two solids by their number: one for every two.
    fn between(&self, number: usize) -> [Solid; 2] {
        let (first, second) = (number / self.width(), number % self.width());
        let second = match second.checked_sub(self.sides.len()) {
            None => Solid::Body(second),
            Some(obstacle) => Solid::Obstacle(obstacle),
        };
        [Solid::Body(first), second]
    }

    /// The number of two solids in ascending order, of which the first is a body.
    fn number(&self, between: [Solid; 2]) -> usize {
        let place = |solid| match solid {
            Solid::Body(i) => i,
            Solid::Obstacle(o) => self.sides.len() + o,
        };
        place(between[0]) * self.width() + place(between[1])
    }

    /// The rule and those of exceptions.
    fn some(&self) -> impl Iterator<Item = &PairRule> {
        self.exceptions.values().flatten().chain([&self.rule])
    }

    /// All pairs in ascending order.
    pub fn all(&self) -> impl Iterator<Item = Pair> + '_ {
        let firsts = (0..self.sides.len()).map(Solid::Body);
        let seconds = |first: Solid| match first {
            Solid::Body(a) => self.seconds(a).map(move |second| [first, second]),
            Solid::Obstacle(_) => unreachable!("surfaces come first"),
        };
        firsts.flat_map(seconds).flat_map(|between| self.pairs(between)).flatten()
    }
}

/// Who is checked against whom, by number.
///
/// The pairs of two solids follow one another, in ascending order of these.
#[derive(Debug, Clone, PartialEq)]
pub struct Pairs(Kind);

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    Listed {
        list: Vec<Pair>,
        /// The numbers of the pairs of two solids, ascending by these.
        numbers: Vec<([Solid; 2], Range<usize>)>,
    },
    /// Two numbers for any two solids: that of the pair in which the first is the source is even, that of the other one odd.
    Ruled(PairRules),
}

impl Default for Pairs {
    fn default() -> Self {
        Self::from(Vec::new())
    }
}

impl From<Vec<Pair>> for Pairs {
    /// The pairs of a list, in which those of two solids follow one another.
    fn from(list: Vec<Pair>) -> Self {
        let mut numbers: BTreeMap<_, Range<usize>> = BTreeMap::new();
        for (p, pair) in list.iter().enumerate() {
            numbers.entry(pair.between()).or_insert(p..p).end = p + 1;
        }
        let numbers = numbers.into_iter().collect();
        Self(Kind::Listed { list, numbers })
    }
}

impl Pairs {
    /// The most solids of which pairs have numbers: these are those of candidates, of 32 bits.
    #[must_use]
    pub fn have_room_for(surfaces: usize, obstacles: usize) -> bool {
        let of_two = (surfaces as u64).saturating_mul((surfaces + obstacles) as u64);
        of_two.saturating_mul(2) <= u64::from(u32::MAX)
    }

    /// All that `rules` allow: listed if they are no more than `many`.
    ///
    /// # Panics
    /// If there is no [room](Self::have_room_for) for so many.
    #[must_use]
    pub fn by(rules: PairRules, many: usize) -> Self {
        assert!(Self::have_room_for(rules.sides.len(), rules.obstacles), "more pairs than numbers");
        // So many there may be.
        let list: Vec<Pair> = rules.all().take(2 * many + 1).collect();
        let pairs = Self::from(list);
        if pairs.between().take(many + 1).count() > many { Self(Kind::Ruled(rules)) } else { pairs }
    }

    /// Whether there are so many that they are not listed.
    #[must_use]
    pub fn are_many(&self) -> bool {
        matches!(self.0, Kind::Ruled(_))
    }

    /// Whether some are written with multipliers.
    #[must_use]
    pub fn have_mortar(&self) -> bool {
        let is_mortar = |discretisation| discretisation == Discretisation::Mortar;
        match &self.0 {
            Kind::Listed { list, .. } => list.iter().any(|pair| is_mortar(pair.discretisation)),
            Kind::Ruled(rules) => rules.some().any(|rule| is_mortar(rule.discretisation)),
        }
    }

    /// The pair of a number.
    ///
    /// # Panics
    /// If there is none.
    #[inline]
    #[must_use]
    pub fn get(&self, number: usize) -> Pair {
        match &self.0 {
            Kind::Listed { list, .. } => list[number],
            Kind::Ruled(_) => self.find(number).expect("a number of a pair"),
        }
    }

    /// The pair of a number, if there is one.
    #[must_use]
    pub fn find(&self, number: usize) -> Option<Pair> {
        match &self.0 {
            Kind::Listed { list, .. } => list.get(number).copied(),
            Kind::Ruled(rules) => {
                if number / 2 >= rules.sides.len() * rules.width() {
                    return None;
                }
                let between = rules.between(number / 2);
                if between[0] <= between[1] { rules.pairs(between)[number % 2] } else { None }
            }
        }
    }

    /// All of them by their numbers; none where they are many.
    #[must_use]
    pub fn listed(&self) -> &[Pair] {
        match &self.0 {
            Kind::Listed { list, .. } => list,
            Kind::Ruled(_) => &[],
        }
    }

    /// All of them with their numbers, ascending.
    pub fn iter(&self) -> Box<dyn Iterator<Item = (usize, Pair)> + '_> {
        match &self.0 {
            Kind::Listed { list, .. } => Box::new(list.iter().copied().enumerate()),
            Kind::Ruled(rules) => {
                Box::new(rules.all().map(|pair| (self.number(&pair).expect("one of all"), pair)))
            }
        }
    }

    /// All solids that may touch, two by two, ascending.
    pub fn between(&self) -> Box<dyn Iterator<Item = [Solid; 2]> + '_> {
        match &self.0 {
            Kind::Listed { numbers, .. } => Box::new(numbers.iter().map(|(between, _)| *between)),
            Kind::Ruled(rules) => {
                let mut last = None;
                let is_new = move |between: &[Solid; 2]| last.replace(*between) != Some(*between);
                Box::new(rules.all().map(|pair| pair.between()).filter(is_new))
            }
        }
    }

    /// The numbers of the pairs of two solids, in either order; none if they never touch.
    #[must_use]
    pub fn of(&self, [a, b]: [Solid; 2]) -> Range<usize> {
        let between = a.pair(b);
        match &self.0 {
            Kind::Listed { numbers, .. } => {
                let place = numbers.binary_search_by_key(&between, |(own, _)| *own);
                place.map_or(0..0, |k| numbers[k].1.clone())
            }
            Kind::Ruled(rules) => {
                let numbers = || 2 * rules.number(between);
                match rules.pairs(between) {
                    [Some(_), Some(_)] => numbers()..numbers() + 2,
                    [Some(_), None] => numbers()..numbers() + 1,
                    [None, Some(_)] => numbers() + 1..numbers() + 2,
                    [None, None] => 0..0,
                }
            }
        }
    }

    /// A number for two solids that may touch, in ascending order: their place among [all](Self::between), where these are listed.
    #[must_use]
    pub fn place(&self, between: [Solid; 2]) -> usize {
        match &self.0 {
            Kind::Listed { numbers, .. } => numbers.partition_point(|(own, _)| *own < between),
            Kind::Ruled(rules) => rules.number(between),
        }
    }

    /// The solids of a [place](Self::place), if there are any.
    #[must_use]
    pub fn at_place(&self, place: usize) -> Option<[Solid; 2]> {
        let between = match &self.0 {
            Kind::Listed { numbers, .. } => numbers.get(place).map(|(between, _)| *between),
            Kind::Ruled(rules) => {
                let is_known = place < rules.sides.len() * rules.width();
                is_known.then(|| rules.between(place)).filter(|[a, b]| a <= b)
            }
        };
        between.filter(|between| self.may_meet(*between))
    }

    /// Whether two solids may touch.
    #[must_use]
    pub fn may_meet(&self, between: [Solid; 2]) -> bool {
        !self.of(between).is_empty()
    }

    /// The number of the pair with this source and target.
    #[must_use]
    pub fn number(&self, pair: &Pair) -> Option<usize> {
        let is_it = |&p: &usize| {
            let other = self.get(p);
            other.source == pair.source && other.target == pair.target
        };
        self.of(pair.between()).find(is_it)
    }

    /// The numbers of the pairs of the same solids as a pair.
    #[must_use]
    pub fn directions(&self, number: usize) -> Range<usize> {
        match &self.0 {
            Kind::Listed { list, .. } => {
                let between = list[number].between();
                let is_of_same = |p: &&Pair| p.between() == between;
                let before = list[..number].iter().rev().take_while(is_of_same).count();
                let after = list[number..].iter().take_while(is_of_same).count();
                number - before..number + after
            }
            Kind::Ruled(_) => self.of(self.get(number).between()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five surfaces, of which some are finer and some touch themselves, before two obstacles.
    fn rules(directions: Directions) -> PairRules {
        let side = |k: usize| Side {
            touches_itself: k % 2 == 0,
            facet_width: [1.0, 0.5, 0.5, 2.0, 1.0][k],
            mass: [1.0, 1.0, 0.9, 1.0, 1.0][k],
        };
        let rule = PairRule { friction: 0.3, discretisation: Discretisation::NodeToSegment, directions };
        let mut exceptions = BTreeMap::new();
        exceptions.insert([Solid::Body(1), Solid::Body(3)], None);
        exceptions.insert([Solid::Body(2), Solid::Obstacle(1)], None);
        exceptions.insert([Solid::Body(2), Solid::Body(2)], None);
        let other = PairRule {
            friction: 0.7,
            discretisation: Discretisation::Mortar,
            directions: Directions::Backward,
        };
        exceptions.insert([Solid::Body(0), Solid::Body(4)], Some(other));
        PairRules { sides: (0..5).map(side).collect(), obstacles: 2, rule, exceptions }
    }

    #[test]
    fn a_rule_has_the_pairs_of_the_list_in_the_same_order() {
        for directions in [Directions::Forward, Directions::Backward, Directions::Both, Directions::Finer] {
            let [listed, ruled] = [1000, 3].map(|many| Pairs::by(rules(directions), many));
            assert!(!listed.are_many() && ruled.are_many());
            let of = |pairs: &Pairs| pairs.iter().map(|(_, pair)| pair).collect::<Vec<_>>();
            assert_eq!(of(&listed), of(&ruled));
            assert_eq!(listed.between().collect::<Vec<_>>(), ruled.between().collect::<Vec<_>>());
            let mut last = None;
            for pairs in [&listed, &ruled] {
                for (p, pair) in pairs.iter() {
                    assert_eq!(
                        (pairs.get(p), pairs.find(p), pairs.number(&pair)),
                        (pair, Some(pair), Some(p))
                    );
                    assert!(pairs.directions(p).contains(&p));
                    assert_eq!(pairs.directions(p), pairs.of(pair.between()));
                    assert_eq!(pairs.at_place(pairs.place(pair.between())), Some(pair.between()));
                }
                let count = pairs.iter().count();
                assert_eq!((0..10_000).filter(|&p| pairs.find(p).is_some()).count(), count);
                assert!(last.is_none_or(|last| last == count));
                last = Some(count);
            }
            // A body with itself: three touch themselves, of which one is an exception.
            assert_eq!(listed.between().filter(|[a, b]| a == b).count(), 2);
            assert_eq!(listed.between().count(), 2 + 10 - 1 + 10 - 1);
            assert!(!ruled.may_meet([Solid::Obstacle(1), Solid::Body(2)]));
            assert!(ruled.may_meet([Solid::Body(3), Solid::Body(2)]));
        }
    }

    #[test]
    fn pairs_of_more_solids_than_numbers_have_no_room() {
        assert!(Pairs::have_room_for(40_000, 10));
        assert!(!Pairs::have_room_for(50_000, 0));
    }
}
