use carom_mesh::Vector;

use crate::aabb::Aabb;

/// A bounding-volume hierarchy: a binary tree of boxes over numbered items, such as facets.
///
/// Its shape comes from where the items were when it was built; [`Bvh::refit`] moves the boxes and allocates nothing. Whatever it
/// finds is independent of its shape. Branches are stored in depth-first order, so that a walk is a loop over an index that either
/// goes on or skips a branch (Smits 1998).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Bvh<const D: usize> {
    branches: Vec<Branch<D>>,
    /// The items, those of a leaf side by side, with their boxes.
    items: Vec<(u32, Aabb<D>)>,
}

#[derive(Debug, Clone, PartialEq)]
struct Branch<const D: usize> {
    bounds: Aabb<D>,
    /// The branch that follows where this one is skipped.
    next: u32,
    /// The items of a leaf; none in an inner branch.
    items: std::ops::Range<u32>,
}

/// Items per leaf, at most.
const LEAF: usize = 4;

impl<const D: usize> Bvh<D> {
    /// A tree over the items 0, 1, … with these boxes.
    pub fn new(boxes: impl Iterator<Item = Aabb<D>>) -> Self {
        let mut tree = Self { branches: Vec::new(), items: (0..).zip(boxes).collect() };
        if !tree.items.is_empty() {
            tree.grow(0..tree.items.len());
        }
        tree
    }

    /// The same items in one leaf: a scan.
    #[cfg(test)]
    pub fn flat(boxes: impl Iterator<Item = Aabb<D>>) -> Self {
        let items: Vec<(u32, Aabb<D>)> = (0..).zip(boxes).collect();
        let root = Branch { bounds: Aabb::of([]), next: 1, items: 0..items.len() as u32 };
        Self { branches: vec![root], items }
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    fn grow(&mut self, range: std::ops::Range<usize>) {
        let place = self.branches.len();
        let all = |boxes: &[(u32, Aabb<D>)]| boxes.iter().fold(Aabb::of([]), |all, (_, b)| all.union(b));
        let items = &mut self.items[range.clone()];
        let bounds = all(items);
        let is_leaf = items.len() <= LEAF;
        let leaf = if is_leaf { range.start as u32..range.end as u32 } else { 0..0 };
        self.branches.push(Branch { bounds, next: 0, items: leaf });
        if !is_leaf {
            let axis = Aabb::of(items.iter().map(|(_, b)| b.centre())).longest_axis();
            let half = items.len() / 2;
            // By number where centres coincide, so that the tree is the same on every machine.
            items.select_nth_unstable_by(half, |(i, a), (j, b)| {
                a.centre()[axis].total_cmp(&b.centre()[axis]).then(i.cmp(j))
            });
            let middle = range.start + half;
            self.grow(range.start..middle);
            self.grow(middle..range.end);
        }
        self.branches[place].next = self.branches.len() as u32;
    }

    /// The box around all items.
    pub fn bounds(&self) -> Aabb<D> {
        self.branches.first().map_or_else(|| Aabb::of([]), |root| root.bounds)
    }

    /// Gives every item its present box.
    pub fn refit(&mut self, bounds: impl Fn(u32) -> Aabb<D>) {
        for (item, own) in &mut self.items {
            *own = bounds(*item);
        }
        for k in (0..self.branches.len()).rev() {
            let Branch { items, .. } = &self.branches[k];
            let bounds = if items.is_empty() {
                let first = &self.branches[k + 1];
                first.bounds.union(&self.branches[first.next as usize].bounds)
            } else {
                let leaf = &self.items[items.start as usize..items.end as usize];
                leaf.iter().fold(Aabb::of([]), |all, (_, b)| all.union(b))
            };
            self.branches[k].bounds = bounds;
        }
    }

    /// Calls `found` with every item whose box overlaps `query`, and with that box.
    #[inline]
    pub fn overlapping(&self, query: &Aabb<D>, found: impl FnMut(u32, &Aabb<D>)) {
        self.each_that(|bounds| bounds.overlaps(query), found);
    }

    /// Calls `found` with every item whose box the segment between two points goes through, and with that box.
    pub fn along(&self, ends: &[Vector<D>; 2], found: impl FnMut(u32, &Aabb<D>)) {
        self.each_that(|bounds| bounds.is_crossed(ends), found);
    }

    #[inline]
    fn each_that(&self, meets: impl Fn(&Aabb<D>) -> bool, mut found: impl FnMut(u32, &Aabb<D>)) {
        let mut k = 0;
        while let Some(branch) = self.branches.get(k) {
            if !meets(&branch.bounds) {
                k = branch.next as usize;
                continue;
            }
            for (item, own) in &self.items[branch.items.start as usize..branch.items.end as usize] {
                if meets(own) {
                    found(*item, own);
                }
            }
            k += 1;
        }
    }

    /// Visits the items that may be nearest to `x`, near branches first. `visit` takes an item and its box and returns the distance
    /// beyond which nothing is of interest any more [m].
    pub fn nearest(&self, x: &Vector<D>, visit: impl FnMut(u32, &Aabb<D>) -> f64) {
        self.nearest_within(f64::INFINITY, x, visit);
    }

    /// The same among those within `reach` [m].
    pub fn nearest_within(&self, mut reach: f64, x: &Vector<D>, mut visit: impl FnMut(u32, &Aabb<D>) -> f64) {
        // Splits are at the median: no tree is deeper than the number of items has bits.
        let mut stack = [(0, 0.0); usize::BITS as usize];
        let mut depth = usize::from(!self.branches.is_empty());
        while depth > 0 {
            depth -= 1;
            let (k, distance) = stack[depth];
            if distance > reach {
                continue;
            }
            let branch = &self.branches[k];
            if branch.items.is_empty() {
                let second = self.branches[k + 1].next as usize;
                let [a, b] = [k + 1, second].map(|child| (child, self.branches[child].bounds.distance(x)));
                let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
                stack[depth] = far;
                stack[depth + 1] = near;
                depth += 2;
            }
            for (item, own) in &self.items[branch.items.start as usize..branch.items.end as usize] {
                if own.distance(x) <= reach {
                    reach = visit(*item, own);
                }
            }
        }
    }
}

/// Gives the `count` items of a tree their boxes.
pub(crate) fn fit<const D: usize>(tree: &mut Bvh<D>, count: usize, bounds: impl Fn(u32) -> Aabb<D>) {
    if tree.len() == count {
        tree.refit(bounds);
    } else {
        *tree = Bvh::new((0..count as u32).map(bounds));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deterministic numbers in 0..1.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    fn boxes<const D: usize>(count: usize, next: &mut impl FnMut() -> f64) -> Vec<Aabb<D>> {
        let mut point = |scale: f64| Vector::<D>::from_fn(|_, _| scale * next());
        (0..count)
            .map(|_| {
                let corner = point(10.0);
                Aabb::of([corner, corner + point(1.0)])
            })
            .collect()
    }

    fn finds_what_a_scan_finds<const D: usize>() {
        let mut next = numbers(7);
        for count in [0, 1, 3, 4, 5, 200] {
            let mut all = boxes::<D>(count, &mut next);
            let mut tree = Bvh::new(all.iter().copied());
            for _ in 0..3 {
                for query in boxes::<D>(50, &mut next) {
                    let mut found = Vec::new();
                    tree.overlapping(&query, |item, own| {
                        assert_eq!(*own, all[item as usize]);
                        found.push(item);
                    });
                    found.sort_unstable();
                    let scan = (0..).zip(&all).filter(|(_, b)| b.overlaps(&query)).map(|(i, _)| i);
                    assert_eq!(found, scan.collect::<Vec<u32>>());
                    let ends = [Vector::repeat(0.5), query.centre()];
                    let mut crossed = Vec::new();
                    tree.along(&ends, |item, _| crossed.push(item));
                    crossed.sort_unstable();
                    let is_on_the_way = |own: &Aabb<D>| {
                        (0..=4000).any(|k| own.contains(&ends[0].lerp(&ends[1], f64::from(k) / 4000.0)))
                    };
                    let on_the_way = (0..).zip(&all).filter(|(_, own)| is_on_the_way(own));
                    assert!(on_the_way.map(|(i, _)| i).all(|i| crossed.contains(&i)));
                    let near = Aabb::of(ends);
                    assert!(crossed.iter().all(|&i| all[i as usize].inflated(1e-6).overlaps(&near)));
                    let x = query.centre();
                    let mut best = f64::INFINITY;
                    tree.nearest(&x, |_, own| {
                        best = best.min(own.distance(&x));
                        best
                    });
                    assert_eq!(best, all.iter().map(|b| b.distance(&x)).fold(f64::INFINITY, f64::min));
                }
                all = boxes::<D>(count, &mut next);
                tree.refit(|item| all[item as usize]);
            }
        }
    }

    #[test]
    fn a_tree_finds_what_a_scan_finds_also_after_its_items_moved() {
        finds_what_a_scan_finds::<2>();
        finds_what_a_scan_finds::<3>();
    }
}
