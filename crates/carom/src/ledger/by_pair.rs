use carom_contact::Solid;

/// What is kept of pairs of solids, in their order: of those that it is kept of. Pairs may be so many that few of them ever touch.
#[derive(Debug, Clone, PartialEq)]
pub struct ByPair<T> {
    entries: Vec<([Solid; 2], T)>,
}

impl<T> Default for ByPair<T> {
    fn default() -> Self {
        Self { entries: Vec::new() }
    }
}

impl<T> ByPair<T> {
    /// What is kept of two solids in ascending order, if it is.
    #[must_use]
    pub fn get(&self, between: [Solid; 2]) -> Option<&T> {
        self.place(between).ok().map(|k| &self.entries[k].1)
    }

    /// The same, with a new one where nothing is kept yet.
    pub fn or_default(&mut self, between: [Solid; 2]) -> &mut T
    where
        T: Default,
    {
        let k = self.place(between).unwrap_or_else(|k| {
            self.entries.insert(k, (between, T::default()));
            k
        });
        &mut self.entries[k].1
    }

    /// Keeps this of two solids in ascending order.
    pub fn insert(&mut self, between: [Solid; 2], value: T) {
        match self.place(between) {
            Ok(k) => self.entries[k].1 = value,
            Err(k) => self.entries.insert(k, (between, value)),
        }
    }

    /// Keeps nothing any more.
    pub fn clear(&mut self) {
        self.entries.clear();
    }

    /// Of how many pairs something is kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Whether nothing is kept.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// All pairs with what is kept of them, ascending.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = ([Solid; 2], &T)> + Clone {
        self.entries.iter().map(|(between, value)| (*between, value))
    }

    /// What is kept.
    pub fn values(&self) -> impl ExactSizeIterator<Item = &T> + Clone {
        self.entries.iter().map(|(_, value)| value)
    }

    /// The same, to be changed.
    pub fn values_mut(&mut self) -> impl ExactSizeIterator<Item = &mut T> {
        self.entries.iter_mut().map(|(_, value)| value)
    }

    fn place(&self, between: [Solid; 2]) -> Result<usize, usize> {
        self.entries.binary_search_by_key(&between, |(own, _)| *own)
    }
}

impl<T> FromIterator<([Solid; 2], T)> for ByPair<T> {
    fn from_iter<I: IntoIterator<Item = ([Solid; 2], T)>>(pairs: I) -> Self {
        let mut all = Self::default();
        pairs.into_iter().for_each(|(between, value)| all.insert(between, value));
        all
    }
}
