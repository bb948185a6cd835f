//! What the names of the parts of a mesh stand for, and how parts get their names.

use std::collections::BTreeSet;

use crate::sets::{ALL, facet_key};
use crate::{Facet, Mesh, Surface, Vector};

/// A name and what tells its members among `T`.
type Named<'a, T> = (&'a str, &'a dyn Fn(&T) -> bool);

impl<const D: usize> Mesh<D> {
    /// The nodes of the set `name`, ascending: its own, and those of its facets and cells. `None` if there is no such set.
    #[must_use]
    pub fn nodes_of(&self, name: &str) -> Option<Vec<u32>> {
        if name == ALL {
            return Some((0..self.nodes().len() as u32).collect());
        }
        let sets = self.sets();
        let (nodes, facets, cells) = (sets.nodes.get(name), sets.facets.get(name), sets.cells.get(name));
        if nodes.is_none() && facets.is_none() && cells.is_none() {
            return None;
        }
        let mut all: BTreeSet<u32> = nodes.into_iter().flatten().copied().collect();
        all.extend(facets.into_iter().flatten().flatten());
        if let Some(cells) = cells {
            let connectivity: Vec<&[u32]> = self.blocks().iter().flat_map(|b| b.cells()).collect();
            all.extend(cells.iter().flat_map(|&c| connectivity[c as usize].iter().copied()));
        }
        Some(all.into_iter().collect())
    }

    /// The part of the boundary `surface` that the set `name` of facets covers. `None` if there is no such set of facets.
    #[must_use]
    pub fn surface_of(&self, name: &str, surface: &Surface) -> Option<Surface> {
        if name == ALL {
            return Some(surface.clone());
        }
        let set = self.sets().facets.get(name)?;
        Some(surface.part(|f| set.contains(&facet_key(&f.nodes))))
    }

    /// The same mesh with one more set of facets: those of the boundary that pass `keep`. It replaces one of the same name.
    #[must_use]
    pub fn with_facet_set(self, name: &str, keep: impl Fn(&Facet) -> bool) -> Self {
        self.with_facet_sets(&[(name, &keep)])
    }

    /// The same mesh with sets of those facets of the boundary of which all nodes are `on` something.
    #[must_use]
    pub fn with_facets_on(self, sets: &[Named<'_, Vector<D>>]) -> Self {
        let nodes = self.nodes().to_vec();
        let tests: Vec<_> =
            sets.iter().map(|(_, on)| |f: &Facet| f.nodes.iter().all(|&n| on(&nodes[n as usize]))).collect();
        let sets: Vec<Named<'_, Facet>> = sets
            .iter()
            .zip(&tests)
            .map(|((name, _), test)| (*name, test as &dyn Fn(&Facet) -> bool))
            .collect();
        self.with_facet_sets(&sets)
    }

    fn with_facet_sets(self, named: &[Named<'_, Facet>]) -> Self {
        let surface = Surface::of(&self);
        let mut sets = self.sets().clone();
        for (name, keep) in named {
            let set = surface.facets().iter().filter(|f| keep(f)).map(|f| facet_key(&f.nodes)).collect();
            sets.facets.insert((*name).to_string(), set);
        }
        self.with_sets_unchecked(sets)
    }

    /// The same mesh with its upright sides named: for each direction the side of the smallest and that of the largest coordinate.
    #[must_use]
    pub fn with_sides(self, names: [[&str; 2]; D]) -> Self {
        let (low, high) = self.bounds();
        let reach: Vector<D> = (high - low) * 1e-9;
        let on = |axis: usize, at: f64| move |x: &Vector<D>| (x[axis] - at).abs() <= reach[axis];
        let tests: Vec<_> = (0..D).flat_map(|k| [on(k, low[k]), on(k, high[k])]).collect();
        let sets: Vec<Named<'_, Vector<D>>> = names
            .iter()
            .flatten()
            .zip(&tests)
            .map(|(name, test)| (*name, test as &dyn Fn(&Vector<D>) -> bool))
            .collect();
        self.with_facets_on(&sets)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::{MeshError, Sets, generate};

    #[test]
    fn sides_of_a_box_hold_its_facets_and_their_nodes() {
        let mesh = generate::grid([0.0, 1.0, 2.0], [1.0, 2.0, 3.0], [2, 3, 4]).expect("valid");
        let mesh = mesh.with_sides([["left", "right"], ["front", "back"], ["bottom", "top"]]);
        let surface = Surface::of(&mesh);
        for (name, facets, axis, at) in [("left", 12, 0, 0.0), ("back", 8, 1, 3.0), ("top", 6, 2, 5.0)] {
            let part = mesh.surface_of(name, &surface).expect("there");
            assert_eq!(part.facets().len(), facets, "{name}");
            let nodes = mesh.nodes_of(name).expect("there");
            assert_eq!(nodes, part.nodes());
            assert!(nodes.iter().all(|&n| mesh.nodes()[n as usize][axis] == at));
        }
        assert_eq!(mesh.sets().names(), ["all", "back", "bottom", "front", "left", "right", "top"]);
        assert_eq!(mesh.nodes_of("lid"), None);
        assert_eq!(mesh.surface_of("all", &surface), Some(surface));
    }

    #[test]
    fn sets_that_refer_to_nothing_are_refused() {
        let mesh = generate::grid([0.0, 0.0], [2.0, 1.0], [2, 1]).expect("valid");
        let nodes = Sets { nodes: BTreeMap::from([("tip".into(), vec![6])]), ..Sets::default() };
        let cells = Sets { cells: BTreeMap::from([("tip".into(), vec![2])]), ..Sets::default() };
        for sets in [nodes, cells] {
            assert!(matches!(
                mesh.clone().with_sets(sets),
                Err(MeshError::UnknownInSet { index: 6 | 2, .. })
            ));
        }
        let good = Sets { cells: BTreeMap::from([("tip".into(), vec![1])]), ..Sets::default() };
        assert_eq!(mesh.with_sets(good).expect("valid").nodes_of("tip"), Some(vec![1, 2, 4, 5]));
    }
}
