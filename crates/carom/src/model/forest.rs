//! What belongs together, directly or through others.

/// Trees of numbers: what is in the same one belongs together. The root is the least of a tree.
#[derive(Debug, Default)]
pub(crate) struct Forest {
    parents: Vec<usize>,
}

impl Forest {
    /// So many numbers, each on its own.
    pub fn begin(&mut self, count: usize) {
        self.parents.clear();
        self.parents.extend(0..count);
    }

    /// The root of the tree of a number.
    pub fn root(&mut self, mut number: usize) -> usize {
        while self.parents[number] != number {
            self.parents[number] = self.parents[self.parents[number]];
            number = self.parents[number];
        }
        number
    }

    /// Makes one tree of those of two numbers; returns the root that stays and the other, which may be the same.
    pub fn join(&mut self, a: usize, b: usize) -> [usize; 2] {
        let [a, b] = [self.root(a), self.root(b)];
        self.parents[a.max(b)] = a.min(b);
        [a.min(b), a.max(b)]
    }
}
