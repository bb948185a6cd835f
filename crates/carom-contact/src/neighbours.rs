use crate::aabb::Aabb;

/// Which of many boxes are near one another, found by sorting them along the first axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Neighbours {
    /// The boxes, ascending by where they begin.
    order: Vec<usize>,
    /// Every box with every other that is near it, ascending.
    pairs: Vec<(usize, usize)>,
}

impl Neighbours {
    /// Finds those of the boxes 0, 1, … below `count` that overlap where one is grown by `reach` [m].
    pub fn find<'a, const D: usize>(
        &mut self,
        count: usize,
        reach: f64,
        bounds: impl Fn(usize) -> &'a Aabb<D>,
    ) {
        let Self { order, pairs } = self;
        order.clear();
        order.extend(0..count);
        order.sort_unstable_by(|&a, &b| bounds(a).side(0)[0].total_cmp(&bounds(b).side(0)[0]));
        pairs.clear();
        for (k, &i) in order.iter().enumerate() {
            let own = bounds(i).inflated(reach);
            let [_, end] = own.side(0);
            for &j in order[k + 1..].iter().take_while(|&&j| bounds(j).side(0)[0] <= end) {
                if own.overlaps(bounds(j)) {
                    pairs.extend([(i, j), (j, i)]);
                }
            }
        }
        pairs.sort_unstable();
    }

    /// Those that are near box `i`, ascending.
    pub fn of(&self, i: usize) -> impl Iterator<Item = usize> {
        let first = self.pairs.partition_point(|&(own, _)| own < i);
        self.pairs[first..].iter().take_while(move |&&(own, _)| own == i).map(|&(_, j)| j)
    }
}

#[cfg(test)]
mod tests {
    use carom_mesh::Vector;

    use super::*;

    /// Boxes of different sizes in a square, some of which hold others, and one that is empty.
    #[test]
    fn the_same_boxes_overlap_as_when_each_is_asked_of_each() {
        let place = |k: usize, by: f64| (by * k as f64).fract() * 5.0;
        let bounds = |k: usize| {
            let corner = Vector::<2>::new(place(k, 0.618), place(k, 0.414));
            let size = 0.2 + place(k, 0.732) * if k % 7 == 0 { 0.5 } else { 0.1 };
            Aabb::of([corner, corner.add_scalar(size)])
        };
        let mut boxes: Vec<Aabb<2>> = (0..60).map(bounds).collect();
        boxes[17] = Aabb::of([]);
        let mut near = Neighbours::default();
        for reach in [0.0, 0.5] {
            near.find(boxes.len(), reach, |k| &boxes[k]);
            let mut count = 0;
            for (i, own) in boxes.iter().enumerate() {
                let own = own.inflated(reach);
                let all = (0..boxes.len()).filter(|&j| j != i && own.overlaps(&boxes[j]));
                count += near.of(i).count();
                assert!(near.of(i).eq(all), "{i}");
            }
            assert!(count > 60, "{count}");
        }
    }
}
