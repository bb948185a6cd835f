//! Structured meshes of simple bodies. One file per shape; `lattice` makes cells of any kind of its points.

mod ball;
mod check;
mod core_block;
mod cylinder;
mod disc;
mod grid;
mod lattice;
mod ring;
mod tie;
mod triangulate;
mod tube;
mod upright;

pub use ball::Ball;
pub use cylinder::Cylinder;
pub use disc::Disc;
pub use grid::{Grid, grid};
pub use ring::Ring;
pub use tie::tie_sides;
pub use triangulate::triangulate;
pub use tube::Tube;
pub use upright::Axis;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CellKind, Mesh};

    #[test]
    fn disc_has_the_nodes_and_cells_of_its_o_grid() {
        let disc = Disc { centre: [2.0, 4.0], radius: 1.0, divisions: 8, rings: None };
        let mesh = disc.quadrilaterals().expect("valid");
        assert_eq!(mesh.nodes().len(), 209);
        assert_eq!(mesh.cell_count(), 64 + 128);
        assert_eq!(disc.mesh(CellKind::Tri3).expect("valid").cell_count(), 2 * 192);
        let disc = Disc { divisions: 10, rings: Some(10), ..disc };
        assert_eq!(disc.quadrilaterals().expect("valid").nodes().len(), 521);
    }

    #[test]
    fn a_side_is_tied_to_the_one_opposite() {
        let mesh = grid([0.1, 0.2], [0.3, 0.7], [3, 2]).expect("valid");
        let tied = tie_sides(mesh.clone(), 0).expect("alike");
        let pairs: Vec<_> = tied.ties().iter().map(|t| (t.image, t.master)).collect();
        assert_eq!(pairs, [(3, 0), (7, 4), (11, 8)]);
        let cut = Grid { corner: [0.1, 0.2], size: [0.3, 0.7], divisions: [3, 2] }.mesh(CellKind::Tri3);
        assert_eq!(tie_sides(cut.expect("valid"), 0).expect("alike").ties(), tied.ties());
        assert_eq!(tie_sides(mesh.clone(), 1).expect("alike").ties().len(), 4);
        let mut nodes = mesh.nodes().to_vec();
        nodes[7][1] += 0.1;
        let skewed = Mesh::new(nodes, mesh.blocks().to_vec()).expect("valid");
        assert_eq!(
            tie_sides(skewed, 0).expect_err("is refused").to_string(),
            "the sides across direction 0 cannot be tied: their nodes are not opposite one another"
        );
    }

    #[test]
    fn impossible_discs_and_grids_are_refused() {
        let disc = Disc { centre: [0.0; 2], radius: 1.0, divisions: 8, rings: None };
        assert!(Disc { radius: -1.0, ..disc }.quadrilaterals().is_err());
        assert!(Disc { divisions: 7, ..disc }.quadrilaterals().is_err());
        assert!(Disc { rings: Some(0), ..disc }.quadrilaterals().is_err());
        assert!(Disc { divisions: usize::MAX - 1, ..disc }.quadrilaterals().is_err());
        assert!(grid([0.0; 2], [1.0; 2], [usize::MAX, 2]).is_err());
        assert!(grid([0.0; 2], [1.0, 0.0], [1, 1]).is_err());
        assert!(grid([0.0; 3], [1.0; 3], [1, 0, 1]).is_err());
    }
}
