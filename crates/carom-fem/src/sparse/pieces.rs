//! How a large factor is taken apart: subtrees of its elimination tree that do not depend on one another, and what is above them.

use std::ops::Range;

use super::control::CONTROL;

/// Ranges of supernodes, ascending and apart, that are whole subtrees of the elimination tree, each with a share of the values of the
/// factor. What is in none is above them. They depend on the factor alone, not on how many threads there are. A small factor has
/// none.
///
/// `parent` of a supernode stands behind it, `usize::MAX` for a root; `values` is its size.
pub(super) fn pieces(parent: &[usize], values: &[usize]) -> Vec<Range<usize>> {
    let n = parent.len();
    let total: usize = values.iter().sum();
    if total < CONTROL.apart {
        return Vec::new();
    }
    // Of every subtree: its values, its supernodes and the first of them.
    let (mut size, mut count, mut first) = (values.to_vec(), vec![1; n], (0..n).collect::<Vec<usize>>());
    for s in 0..n {
        if let Some(above) = Some(parent[s]).filter(|&p| p < n) {
            size[above] += size[s];
            count[above] += count[s];
            first[above] = first[above].min(first[s]);
        }
    }
    let is_piece = |s: usize| {
        size[s] * CONTROL.share <= total
            && size[s] * CONTROL.small_share >= total
            && first[s] + count[s] == s + 1
    };
    // The largest such subtrees: from the roots down.
    let mut covered = vec![false; n];
    let mut pieces = Vec::new();
    for s in (0..n).rev() {
        let inside = parent[s] < n && covered[parent[s]];
        covered[s] = inside || is_piece(s);
        if covered[s] && !inside {
            pieces.push(first[s]..s + 1);
        }
    }
    pieces.reverse();
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A binary tree in postorder whose separators are as large as their halves of the tree above 2¹⁵ values.
    fn tree(levels: u32, values: usize) -> (Vec<usize>, Vec<usize>) {
        if levels == 0 {
            return (vec![usize::MAX], vec![values]);
        }
        let (half, sizes) = tree(levels - 1, values / 2);
        let n = half.len();
        let root = 2 * n;
        let link = |offset: usize| {
            half.iter().map(move |&p| if p == usize::MAX { root } else { p + offset }).collect::<Vec<_>>()
        };
        let parent = [link(0), link(n), vec![usize::MAX]].concat();
        (parent, [sizes.clone(), sizes, vec![values / 4]].concat())
    }

    #[test]
    fn pieces_are_whole_subtrees_that_share_the_work() {
        let (parent, values) = tree(12, 1 << 23);
        let pieces = pieces(&parent, &values);
        assert!(pieces.len() >= 8, "{pieces:?}");
        let total: usize = values.iter().sum();
        for (k, piece) in pieces.iter().enumerate() {
            assert!(k == 0 || pieces[k - 1].end <= piece.start);
            let root = piece.end - 1;
            // Only the root leads out, and nothing from outside leads in.
            for s in 0..parent.len() {
                let leads_in = parent[s] < parent.len() && piece.contains(&parent[s]);
                assert_eq!(piece.contains(&s) && s != root, leads_in);
            }
            assert!(values[piece.clone()].iter().sum::<usize>() <= total / 10);
        }
    }

    #[test]
    fn a_small_factor_stays_whole() {
        let (parent, values) = tree(8, 1 << 18);
        assert_eq!(pieces(&parent, &values), []);
    }
}
