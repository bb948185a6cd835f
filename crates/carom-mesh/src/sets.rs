//! Named parts of a mesh.

use std::collections::{BTreeMap, BTreeSet};

/// The name of the set that every mesh has: all its nodes, its whole boundary, all its cells.
pub const ALL: &str = "all";

/// Named parts of a mesh, as generators and mesh files give them. A name may stand for nodes, facets and cells at once.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Sets {
    /// Nodes.
    pub nodes: BTreeMap<String, Vec<u32>>,
    /// Facets, each by its nodes in ascending order.
    pub facets: BTreeMap<String, BTreeSet<Vec<u32>>>,
    /// Cells, numbered block after block.
    pub cells: BTreeMap<String, Vec<u32>>,
}

impl Sets {
    /// Every name, sorted, with `"all"` in front.
    #[must_use]
    pub fn names(&self) -> Vec<&str> {
        let named = self.nodes.keys().chain(self.facets.keys()).chain(self.cells.keys());
        let named: BTreeSet<&str> = named.map(String::as_str).filter(|&name| name != ALL).collect();
        std::iter::once(ALL).chain(named).collect()
    }

    /// Names of what facets can be taken of, sorted, with `"all"` in front.
    #[must_use]
    pub fn facet_names(&self) -> Vec<&str> {
        std::iter::once(ALL)
            .chain(self.facets.keys().map(String::as_str).filter(|&name| name != ALL))
            .collect()
    }
}

/// What identifies a facet whichever way it turns: its nodes in ascending order.
#[must_use]
pub fn facet_key(nodes: &[u32]) -> Vec<u32> {
    let mut key = nodes.to_vec();
    key.sort_unstable();
    key
}
