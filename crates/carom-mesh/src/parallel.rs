//! Work shared by threads: only where there is much of it, and so that the results are those of one thread to the last bit.
//!
//! The threads are those of the rayon pool that a step is made in. Every number is computed by one thread, by the same operations in
//! the same order whatever their count.

use std::ops::Range;

use rayon::prelude::*;

/// Nodes that a thread takes at a time.
pub const CHUNK: usize = 1024;
/// Nodes from which waking another thread is worth its time.
pub const MANY: usize = 16 * CHUNK;
/// Nodes that are as much work as one cell.
pub const NODES_PER_CELL: usize = 2;

/// Nodes of several bodies from which a thread is worth waking for half of them.
pub const BODIES: usize = 2 * CHUNK;
/// Surfaces of bodies that a thread takes at a time.
pub const SURFACES: usize = 32;

/// How many threads may work.
#[must_use]
pub fn thread_count() -> usize {
    rayon::current_num_threads()
}

/// Whether more than one thread may work.
#[must_use]
pub fn has_threads() -> bool {
    thread_count() > 1
}

/// Does `work` on so many nodes in one of the threads that share them, if there are any. From another thread, each sharing would have to wake
/// one and wait for it: a step of 100 discs was a third slower with two threads than with one.
pub fn among_threads<R: Send>(nodes: usize, work: impl FnOnce() -> R + Send) -> R {
    if nodes < BODIES || !has_threads() { work() } else { rayon::scope(|_| work()) }
}

/// Does both, in two threads if there are.
pub fn both<A: Send, B: Send>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B + Send) -> (A, B) {
    rayon::join(a, b)
}

/// Calls `work` with consecutive parts of `items` that together are all of them, and the index where each begins.
pub fn each_chunk<T: Send>(items: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) {
    if items.len() < MANY || !has_threads() {
        return work(0, items);
    }
    share(items, CHUNK, &work);
}

/// Calls `work` with consecutive `chunk`s of `items`, which the threads share, and the index where each begins.
///
/// What rayon makes of it is a thousand lines of code for every closure: through `dyn` they are compiled once for every `T`.
pub fn share<T: Send>(items: &mut [T], chunk: usize, work: &(dyn Fn(usize, &mut [T]) + Sync)) {
    items.par_chunks_mut(chunk).enumerate().for_each(|(number, items)| work(number * chunk, items));
}

/// Calls `work` with consecutive groups of so many `items`, each of which is as much work as a waking thread is worth, and the index where each
/// begins.
pub fn each_group<T: Send>(items: &mut [T], group: usize, work: impl Fn(usize, &mut [T]) + Sync) {
    if items.len() <= group || !has_threads() {
        return work(0, items);
    }
    share(items, group, &work);
}

/// As [`each_chunk`], with parts of two slices of one length.
pub fn each_chunk_of_two<A: Send, B: Send>(
    a: &mut [A],
    b: &mut [B],
    work: impl Fn(usize, &mut [A], &mut [B]) + Sync,
) {
    if a.len() < MANY || !has_threads() {
        return work(0, a, b);
    }
    let chunks = a.par_chunks_mut(CHUNK).zip(b.par_chunks_mut(CHUNK)).enumerate();
    chunks.for_each(|(number, (a, b))| work(number * CHUNK, a, b));
}

/// What `part` gives for consecutive parts of `items` that together are all of them, `joined` to one.
///
/// The parts depend on the number of items alone, so that a sum has the same last digits with any number of threads.
pub fn reduce<T: Send>(
    items: Range<usize>,
    part: &(dyn Fn(Range<usize>) -> T + Sync),
    joined: &(dyn Fn(T, T) -> T + Sync),
) -> T {
    if items.len() < MANY {
        return part(items);
    }
    let middle = items.start + items.len() / 2;
    let (left, right) =
        (|| reduce(items.start..middle, part, joined), || reduce(middle..items.end, part, joined));
    let (left, right) = if has_threads() { rayon::join(left, right) } else { (left(), right()) };
    joined(left, right)
}
