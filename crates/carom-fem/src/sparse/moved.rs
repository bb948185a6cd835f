use super::region::Region;
use super::rows::{ELSEWHERE, Rows, Split};
use super::scaled::Scaled;

/// What forces at some nodes move, ring by ring, and the rows of it that are here.
#[derive(Debug, Default)]
pub(super) struct Moved {
    region: Region,
    /// Where other processes have rows, those that are here, and where those of each ring end; else nothing.
    rows: Split,
    ends: Vec<[usize; 2]>,
}

impl Moved {
    /// Takes the nodes that are at most so many `rings` from those in the `middle`.
    pub fn grow<const D: usize>(
        &mut self,
        matrix: &Scaled<D>,
        middle: impl Iterator<Item = u32>,
        rings: usize,
    ) {
        self.region.grow(matrix.graph(), middle, rings);
        self.ends.clear();
        if let Some(rows) = matrix.rows() {
            self.take_rows(rows);
        }
    }

    fn take_rows(&mut self, all: &Rows) {
        let Self { region, rows, ends, .. } = self;
        rows.whole.clear();
        rows.split.clear();
        for ring in region.rings() {
            all.add(ring.iter().copied(), rows);
            ends.push([rows.whole.len(), rows.split.len()]);
        }
    }

    /// Its nodes, ring by ring.
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// The places up to the given ring, and those that are [split](Rows); all of them beyond the last.
    pub fn up_to(&self, ring: usize) -> (&[u32], &[u32]) {
        if self.ends.is_empty() {
            return (self.region.up_to(ring), &[]);
        }
        let [whole, split] = self.ends[ring.min(self.ends.len() - 1)];
        (&self.rows.whole[..whole], &self.rows.split[..split])
    }

    /// All places here.
    pub fn everywhere(&self) -> impl Iterator<Item = usize> {
        self.here(usize::MAX)
    }

    /// All places here up to the given ring.
    pub fn here(&self, ring: usize) -> impl Iterator<Item = usize> {
        let (whole, split) = self.up_to(ring);
        let split = split.iter().filter(|&&place| place != ELSEWHERE);
        whole.iter().chain(split).map(|&place| place as usize)
    }
}
