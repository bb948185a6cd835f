use feral_metis::{CscPattern, metis_order};

use super::NodeGraph;
use super::control::CONTROL;

/// An order in which the nodes of a large graph are eliminated with little fill, position by position; `None` for a small one.
///
/// Nested dissection (Karypis & Kumar, SIAM J. Sci. Comput. 20, 1998) of the nodes, not of the unknowns: those of a node have the
/// same neighbours. In space a factor so ordered has a fraction of the values that minimum degree leaves. The order is a
/// postorder of the elimination tree, so that columns of like structure are neighbours and make large supernodes.
///
/// The nodes in `last` are eliminated after all others. The last columns of the factor are then that of their Schur complement, and solutions there
/// for forces there need no others.
pub fn nested_dissection(graph: &NodeGraph, last: &[u32]) -> Option<Vec<usize>> {
    let n = graph.node_count();
    if n < CONTROL.dissected {
        return None;
    }
    const LAST: i32 = -1;
    let mut place = vec![0_i32; n];
    last.iter().for_each(|&node| place[node as usize] = LAST);
    let others: Vec<usize> = (0..n).filter(|&node| place[node] != LAST).collect();
    (0..).zip(&others).for_each(|(k, &node)| place[node] = k);
    let mut starts = vec![0_i32];
    let mut neighbours = Vec::with_capacity(graph.entry_count());
    for &node in &others {
        let around = graph.row(node).filter(|&(_, m)| m != node).map(|(_, m)| place[m]);
        neighbours.extend(around.filter(|&k| k != LAST));
        starts.push(i32::try_from(neighbours.len()).ok()?);
    }
    let order = metis_order(&CscPattern::new(others.len(), &starts, &neighbours)?).ok()?;
    let order = order.into_iter().map(|k| others[k as usize]);
    let order: Vec<usize> = order.chain(last.iter().map(|&node| node as usize)).collect();
    Some(postordered(graph, &order))
}

/// The same elimination with every subtree of its elimination tree in one piece.
fn postordered(graph: &NodeGraph, order: &[usize]) -> Vec<usize> {
    let parent = elimination_tree(graph, order);
    let n = order.len();
    // Children in ascending order: the list of each is filled from behind.
    let (mut first_child, mut sibling) = (vec![usize::MAX; n + 1], vec![usize::MAX; n]);
    for k in (0..n).rev() {
        let above = parent[k].min(n);
        sibling[k] = first_child[above];
        first_child[above] = k;
    }
    let mut post = Vec::with_capacity(n);
    let mut path = vec![n];
    while let Some(&k) = path.last() {
        let child = first_child[k];
        if child != usize::MAX {
            first_child[k] = sibling[child];
            path.push(child);
        } else {
            path.pop();
            if k < n {
                post.push(order[k]);
            }
        }
    }
    post
}

/// The parent of every column of the factor, `usize::MAX` for a root (Liu, ACM Trans. Math. Softw. 12, 1986).
fn elimination_tree(graph: &NodeGraph, order: &[usize]) -> Vec<usize> {
    let n = order.len();
    let mut place = vec![0; n];
    order.iter().enumerate().for_each(|(k, &node)| place[node] = k);
    let (mut parent, mut ancestor) = (vec![usize::MAX; n], vec![usize::MAX; n]);
    for (k, &node) in order.iter().enumerate() {
        for (_, neighbour) in graph.row(node) {
            let mut column = place[neighbour];
            // Climb to the root of the subtree, which k then joins; the way is shortened for the next climb.
            while column < k {
                let next = std::mem::replace(&mut ancestor[column], k);
                if next == usize::MAX {
                    parent[column] = k;
                    break;
                }
                column = next;
            }
        }
    }
    parent
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_mesh::generate;

    #[test]
    fn every_node_is_eliminated_once_and_after_its_subtree() {
        let mesh = generate::grid([0.0; 3], [1.0; 3], [16, 16, 15]).expect("valid");
        let graph = NodeGraph::of(&mesh);
        let order = nested_dissection(&graph, &[]).expect("large");
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..graph.node_count()));
        // In a postorder the descendants of a column stand right before it.
        let parent = elimination_tree(&graph, &order);
        let mut size = vec![1; order.len()];
        let mut lowest: Vec<usize> = (0..order.len()).collect();
        for k in 0..order.len() {
            assert_eq!(lowest[k] + size[k], k + 1);
            if parent[k] != usize::MAX {
                size[parent[k]] += size[k];
                lowest[parent[k]] = lowest[parent[k]].min(lowest[k]);
            }
        }
        assert_eq!(parent.iter().filter(|&&p| p == usize::MAX).count(), 1, "one piece, one root");
    }

    #[test]
    fn last_nodes_are_eliminated_last() {
        let mesh = generate::grid([0.0; 3], [1.0; 3], [16, 16, 15]).expect("valid");
        let graph = NodeGraph::of(&mesh);
        let last: Vec<u32> = (0..17 * 17).collect();
        let order = nested_dissection(&graph, &last).expect("large");
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().copied().eq(0..graph.node_count()));
        let (_, ends) = order.split_at(order.len() - last.len());
        assert!(ends.iter().all(|&node| node < last.len()));
    }

    #[test]
    fn small_graphs_are_left_to_minimum_degree() {
        let mesh = generate::grid([0.0; 2], [1.0; 2], [5, 4]).expect("valid");
        assert_eq!(nested_dissection(&NodeGraph::of(&mesh), &[]), None);
    }
}
