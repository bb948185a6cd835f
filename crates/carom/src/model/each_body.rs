//! Work on every body of a step, shared by threads where there is much of it.
//!
//! Bodies are coupled in contacts alone: between these each stage of a step is the same work on one body after the other. What a body
//! writes is its own, so the numbers are those of one thread to the last bit.

use std::convert::Infallible;
use std::ops::Range;

use carom_mesh::Vector;
use carom_mesh::parallel::{BODIES, both, has_threads};

use crate::model::assembly::Assembly;

/// What belongs to bodies, and can be cut between two of them.
pub(crate) trait Cut: Send + Sized {
    /// What belongs to the first `bodies`, which have so many `nodes` in all, and the rest.
    fn cut(self, bodies: usize, nodes: usize) -> (Self, Self);
}

/// An entry per body.
pub(crate) struct PerBody<'a, T>(pub &'a mut [T]);

/// An entry per node of every body, one body after the other; what follows belongs to none.
pub(crate) struct PerNode<'a, T>(pub &'a mut [T]);

impl<T: Send> Cut for PerBody<'_, T> {
    fn cut(self, bodies: usize, _nodes: usize) -> (Self, Self) {
        let (first, rest) = self.0.split_at_mut(bodies);
        (Self(first), Self(rest))
    }
}

impl<'a, T> PerBody<'a, T> {
    /// The entry of a body alone.
    pub fn own(self) -> &'a mut T {
        &mut self.0[0]
    }
}

impl<T: Send> Cut for PerNode<'_, T> {
    fn cut(self, _bodies: usize, nodes: usize) -> (Self, Self) {
        let (first, rest) = self.0.split_at_mut(nodes);
        (Self(first), Self(rest))
    }
}

impl<A: Cut, B: Cut> Cut for (A, B) {
    fn cut(self, bodies: usize, nodes: usize) -> (Self, Self) {
        let (a, b) = (self.0.cut(bodies, nodes), self.1.cut(bodies, nodes));
        ((a.0, b.0), (a.1, b.1))
    }
}

impl<A: Cut, B: Cut, C: Cut> Cut for (A, B, C) {
    fn cut(self, bodies: usize, nodes: usize) -> (Self, Self) {
        let (a, b) = ((self.0, self.1).cut(bodies, nodes), self.2.cut(bodies, nodes));
        ((a.0.0, a.0.1, b.0), (a.1.0, a.1.1, b.1))
    }
}

impl<A: Cut, B: Cut, C: Cut, D: Cut> Cut for (A, B, C, D) {
    fn cut(self, bodies: usize, nodes: usize) -> (Self, Self) {
        let (a, b) = ((self.0, self.1).cut(bodies, nodes), (self.2, self.3).cut(bodies, nodes));
        ((a.0.0, a.0.1, b.0.0, b.0.1), (a.1.0, a.1.1, b.1.0, b.1.1))
    }
}

/// Does `work` on each of these `bodies`, ascending, with what of `all` belongs to it.
pub(crate) fn each_body<const D: usize, P: Cut>(
    assembly: &Assembly<D>,
    bodies: &[usize],
    all: P,
    work: &(impl Fn(usize, P) + Sync),
) {
    let work = |i: usize, own: P| -> Result<(), Infallible> {
        work(i, own);
        Ok(())
    };
    let Ok(()) = try_each_body(assembly, bodies, all, &work);
}

/// The same of work that may fail.
///
/// # Errors
/// That of the first body that fails; what the others did is of no use then.
pub(crate) fn try_each_body<const D: usize, P: Cut, E: Send>(
    assembly: &Assembly<D>,
    bodies: &[usize],
    all: P,
    work: &(impl Fn(usize, P) -> Result<(), E> + Sync),
) -> Result<(), E> {
    share(assembly, bodies, all, [0, 0], work)
}

/// Calls `work` with every run of nodes that iterations move, of all bodies, and with the obstacles: what is of them in `out`, and their numbers.
pub(crate) fn each_run<const D: usize>(
    assembly: &Assembly<D>,
    out: &mut [Vector<D>],
    work: &(impl Fn(&mut [Vector<D>], Range<usize>) + Sync),
) {
    let (bodies, obstacles) = out.split_at_mut(assembly.node_count());
    each_body(assembly, &assembly.everyone, PerNode(bodies), &|i, own| {
        for run in assembly.stepped(i) {
            work(&mut own.0[run.clone()], assembly.numbered(i, run));
        }
    });
    work(obstacles, assembly.node_count()..assembly.reference.len());
}

/// [`each_body`] by one thread, of work that writes more than what belongs to a body.
pub(crate) fn each_body_in_turn<const D: usize, P: Cut>(
    assembly: &Assembly<D>,
    bodies: &[usize],
    all: P,
    mut work: impl FnMut(usize, P),
) {
    let work = |i: usize, own: P| -> Result<(), Infallible> {
        work(i, own);
        Ok(())
    };
    let Ok(()) = in_turn(assembly, bodies, all, [0, 0], work);
}

/// [`try_each_body`] of what begins at the body and the node of these numbers.
fn share<const D: usize, P: Cut, E: Send>(
    assembly: &Assembly<D>,
    bodies: &[usize],
    all: P,
    [first_body, first_node]: [usize; 2],
    work: &(impl Fn(usize, P) -> Result<(), E> + Sync),
) -> Result<(), E> {
    let nodes = || bodies.iter().map(|&i| assembly.nodes(i).len()).sum::<usize>();
    if bodies.len() > 1 && has_threads() && nodes() > BODIES {
        let (before, after) = bodies.split_at(bodies.len() / 2);
        let middle = [after[0], assembly.nodes(after[0]).start];
        let (left, right) = all.cut(middle[0] - first_body, middle[1] - first_node);
        let (left, right) = both(
            || share(assembly, before, left, [first_body, first_node], work),
            || share(assembly, after, right, middle, work),
        );
        return left.and(right);
    }
    in_turn(assembly, bodies, all, [first_body, first_node], work)
}

/// The same by one thread.
fn in_turn<const D: usize, P: Cut, E>(
    assembly: &Assembly<D>,
    bodies: &[usize],
    all: P,
    [mut body, mut node]: [usize; 2],
    mut work: impl FnMut(usize, P) -> Result<(), E>,
) -> Result<(), E> {
    let mut rest = all;
    for &i in bodies {
        let own = assembly.nodes(i);
        let (_, from) = rest.cut(i - body, own.start - node);
        let (mine, after) = from.cut(1, own.len());
        work(i, mine)?;
        (rest, body, node) = (after, i + 1, own.end);
    }
    Ok(())
}
