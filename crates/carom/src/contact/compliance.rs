//! How the nodes of one body yield to forces on one another: blocks of K̄⁻¹.

use carom_fem::Body;
use carom_mesh::Matrix;

use crate::body::fe::operator::BodyOperator;

/// Contact nodes of a body up to which every pair of them has its block.
const FEW: usize = 100;
/// Beyond these, a node has blocks with the nodes of the surface that it reaches in so many cells. Within a step of time a force is
/// felt as far as a wave goes; what W lacks of that costs iterations, not accuracy (see [`crate::contact::delassus::condense`]).
const RINGS: usize = 3;

/// The blocks of K̄⁻¹ of one body between the nodes that have been in contact, computed when a node first is and kept with the
/// factor.
#[derive(Debug)]
pub(crate) struct Compliance<const D: usize> {
    /// The nodes, in the order of their first contact.
    nodes: Vec<u32>,
    /// Place of every node of the body among them, or `u32::MAX`.
    places: Vec<u32>,
    table: Table<D>,
    generation: u64,
}

#[derive(Debug)]
enum Table<const D: usize> {
    /// The blocks (K̄⁻¹)_ab in the frame of the factor, by the place of b and then that of a, which is no larger.
    All(Vec<Matrix<D>>),
    /// Columns, by place.
    Near(Near<D>),
}

/// The blocks of every column with the nodes near it, itself among them.
#[derive(Debug)]
struct Near<const D: usize> {
    /// Whether a node is on the surface.
    surface: Vec<bool>,
    starts: Vec<usize>,
    /// Ascending within a column.
    others: Vec<u32>,
    blocks: Vec<Matrix<D>>,
}

impl<const D: usize> Near<D> {
    fn new(body: &Body<D>) -> Self {
        let mut surface = vec![false; body.node_count()];
        body.surface().nodes().iter().for_each(|&node| surface[node as usize] = true);
        Self { surface, starts: vec![0], others: Vec::new(), blocks: Vec::new() }
    }

    /// Appends the columns of `nodes`.
    fn extend(&mut self, body: &Body<D>, operator: &mut BodyOperator<D>, nodes: &[u32]) {
        let known = self.starts.len() - 1;
        for &node in nodes {
            self.find_others(body, node);
        }
        self.blocks.resize(self.others.len(), Matrix::zeros());
        let mut order: Vec<usize> = (0..nodes.len()).collect();
        order.sort_by_key(|&k| operator.order(nodes[k] as usize));
        for group in order.chunks(BodyOperator::<D>::AT_ONCE) {
            let others = group.iter().flat_map(|&k| &self.others[self.column(known + k)]);
            operator.set_reach(others.map(|&a| a as usize));
            operator.respond(group.iter().map(|&k| nodes[k] as usize));
            for (number, &k) in group.iter().enumerate() {
                for entry in self.column(known + k) {
                    self.blocks[entry] =
                        operator.response(self.others[entry] as usize, (number, nodes[k] as usize));
                }
            }
        }
    }

    /// Appends the nodes of the column of `node`: ring by ring those that share a cell with others found so far, also by ways that lead
    /// through the inside.
    fn find_others(&mut self, body: &Body<D>, node: u32) {
        let Self { surface, starts, others, .. } = self;
        let first = others.len();
        others.push(node);
        let mut found = vec![node];
        for _ in 0..RINGS {
            found = found.iter().flat_map(|&n| body.graph().row(n as usize).map(|(_, m)| m as u32)).collect();
            found.sort_unstable();
            found.dedup();
        }
        others.extend(found.into_iter().filter(|&n| n != node && surface[n as usize]));
        others[first..].sort_unstable();
        starts.push(others.len());
    }

    fn column(&self, place: usize) -> std::ops::Range<usize> {
        self.starts[place]..self.starts[place + 1]
    }
}

impl<const D: usize> Compliance<D> {
    pub fn new(body: &Body<D>) -> Self {
        Self {
            nodes: Vec::new(),
            places: vec![u32::MAX; body.node_count()],
            table: Table::All(Vec::new()),
            generation: 0,
        }
    }

    /// Makes sure that the blocks between `nodes` are there and belong to the present factor. If forces are not felt `everywhere` at
    /// once, as in a static analysis, many nodes have blocks only with those around them.
    pub fn prepare(
        &mut self,
        body: &Body<D>,
        operator: &mut BodyOperator<D>,
        nodes: &[u32],
        everywhere: bool,
    ) {
        if self.generation != operator.generation {
            self.clear();
            self.generation = operator.generation;
        }
        let new = nodes.iter().filter(|&&node| self.places[node as usize] == u32::MAX).count();
        if new == 0 {
            return;
        }
        let many = self.nodes.len() + new > FEW && !everywhere;
        if many && matches!(self.table, Table::All(_)) {
            self.clear();
            self.table = Table::Near(Near::new(body));
        }
        self.extend(body, operator, nodes);
    }

    /// The nodes whose blocks belong to the present factor, in the order of their first contact, and whether they have these only
    /// with the nodes near them.
    pub fn kept(&self, operator: &BodyOperator<D>) -> (&[u32], bool) {
        let nodes: &[u32] = if self.generation == operator.generation { &self.nodes } else { &[] };
        (nodes, !nodes.is_empty() && matches!(self.table, Table::Near(_)))
    }

    /// Makes the blocks that there were when [`Self::kept`] gave this answer.
    pub fn restore(&mut self, body: &Body<D>, operator: &mut BodyOperator<D>, nodes: &[u32], near: bool) {
        self.clear();
        self.generation = operator.generation;
        if near {
            self.table = Table::Near(Near::new(body));
        }
        self.extend(body, operator, nodes);
    }

    /// Adds the blocks of those of `nodes` that have none.
    fn extend(&mut self, body: &Body<D>, operator: &mut BodyOperator<D>, nodes: &[u32]) {
        let known = self.nodes.len();
        for &node in nodes {
            let place = &mut self.places[node as usize];
            if *place == u32::MAX {
                *place = self.nodes.len() as u32;
                self.nodes.push(node);
            }
        }
        match &mut self.table {
            Table::All(blocks) => {
                operator.set_reach(self.nodes.iter().map(|&node| node as usize));
                let mut place = known;
                for group in self.nodes[known..].chunks(BodyOperator::<D>::AT_ONCE) {
                    operator.respond(group.iter().map(|&b| b as usize));
                    for (number, &b) in group.iter().enumerate() {
                        let others = self.nodes[..=place].iter();
                        blocks.extend(others.map(|&a| operator.response(a as usize, (number, b as usize))));
                        place += 1;
                    }
                }
            }
            Table::Near(near) => near.extend(body, operator, &self.nodes[known..]),
        }
    }

    fn clear(&mut self) {
        self.nodes.drain(..).for_each(|node| self.places[node as usize] = u32::MAX);
        self.table = Table::All(Vec::new());
    }

    /// The nodes that have blocks with a node that was prepared; None if all have.
    #[inline]
    pub fn near(&self, node: usize) -> Option<&[u32]> {
        match &self.table {
            Table::All(_) => None,
            Table::Near(near) => Some(&near.others[near.column(self.places[node] as usize)]),
        }
    }

    /// The block (K̄⁻¹)_ab of two nodes that were prepared, in the frame of the factor, if they have one.
    #[inline]
    pub fn block(&self, a: usize, b: usize) -> Option<Matrix<D>> {
        let (a_place, b_place) = (self.places[a] as usize, self.places[b] as usize);
        match &self.table {
            Table::All(blocks) if a_place <= b_place => Some(blocks[b_place * (b_place + 1) / 2 + a_place]),
            Table::All(blocks) => Some(blocks[a_place * (a_place + 1) / 2 + b_place].transpose()),
            Table::Near(near) => {
                let column = near.column(b_place);
                let place = near.others[column.clone()].binary_search(&(a as u32)).ok()?;
                Some(near.blocks[column.start + place])
            }
        }
    }
}
