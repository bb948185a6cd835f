//! What belongs together, directly or through others.

/// Trees of numbers: what is in the same one belongs together. The root is the least of a tree.
#[derive(Debug, Default)]
pub(crate) struct Forest {
    parents: Vec<usize>,
}

impl Forest {
    /// Of so many numbers, each on its own.
    pub fn new(count: usize) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// Makes it one of so many numbers, each on its own.
    pub fn begin(&mut self, count: usize) {
        self.parents.clear();
        self.parents.extend(0..count);
    }

    /// Puts a number on its own again, whose whole tree is to be.
    pub fn part(&mut self, number: usize) {
        self.parents[number] = number;
    }

    /// Puts a number where it is in `other`: so must all of its tree be.
    pub fn take(&mut self, number: usize, other: &Self) {
        self.parents[number] = other.parents[number];
    }

    /// The root of the tree of a number.
    pub fn root_of(&self, mut number: usize) -> usize {
        while self.parents[number] != number {
            number = self.parents[number];
        }
        number
    }

    /// The same, and the way to it becomes shorter.
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
