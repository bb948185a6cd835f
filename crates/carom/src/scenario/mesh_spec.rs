use carom_mesh::CellKind;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

/// A kind of cell by its name in the case file, such as `"hex8"`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cell(pub CellKind);

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.reference().name)
    }
}

impl<'de> Deserialize<'de> for Cell {
    fn deserialize<T: Deserializer<'de>>(deserializer: T) -> Result<Self, T::Error> {
        let name = String::deserialize(deserializer)?;
        let kind = CellKind::ALL.into_iter().find(|kind| kind.reference().name == name);
        kind.map(Self).ok_or_else(|| de::Error::custom(format!("there is no cell {name:?}")))
    }
}

/// Where a mesh comes from. Cells that are not given are quad4 or hex8.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum MeshSpec {
    /// A disc meshed by an O-grid.
    Disc {
        /// Centre [m].
        centre: [f64; 2],
        /// Radius [m].
        radius: f64,
        /// Cells along a side of the core.
        divisions: usize,
        /// Rings around the core; half of `divisions` if not given.
        rings: Option<usize>,
        /// Cells.
        cell: Option<Cell>,
    },
    /// A rectangle of equal cells.
    Rectangle {
        /// Lower left corner [m].
        corner: [f64; 2],
        /// Sides [m].
        size: [f64; 2],
        /// Cells per side.
        divisions: [usize; 2],
        /// Cells.
        cell: Option<Cell>,
        /// Whether the right side moves as the left one does: the body repeats itself along x.
        #[serde(default)]
        periodic: bool,
    },
    /// The plane between two circles.
    Ring {
        /// Centre [m].
        centre: [f64; 2],
        /// Radius of the hole [m].
        inner_radius: f64,
        /// Radius of the outer circle [m].
        outer_radius: f64,
        /// Cells around and across.
        divisions: [usize; 2],
        /// Cells.
        cell: Option<Cell>,
    },
    /// A box of equal cells.
    Box {
        /// Corner of the smallest coordinates [m].
        corner: [f64; 3],
        /// Sides [m].
        size: [f64; 3],
        /// Cells per side.
        divisions: [usize; 3],
        /// Cells.
        cell: Option<Cell>,
    },
    /// A ball meshed by an O-grid.
    Ball {
        /// Centre [m].
        centre: [f64; 3],
        /// Radius [m].
        radius: f64,
        /// Cells along an edge of the core.
        divisions: usize,
        /// Shells around the core; half of `divisions` if not given.
        rings: Option<usize>,
        /// Cells.
        cell: Option<Cell>,
    },
    /// Layers of a disc.
    Cylinder {
        /// Centre of the bottom [m].
        base: [f64; 3],
        /// Direction from the bottom to the top.
        axis: [f64; 3],
        /// Radius [m].
        radius: f64,
        /// Distance between bottom and top [m].
        height: f64,
        /// Cells along a side of the core.
        divisions: usize,
        /// Rings around the core; half of `divisions` if not given.
        rings: Option<usize>,
        /// Cells along the axis.
        layers: usize,
        /// Cells.
        cell: Option<Cell>,
    },
    /// Layers of a ring.
    Tube {
        /// Centre of the bottom [m].
        base: [f64; 3],
        /// Direction from the bottom to the top.
        axis: [f64; 3],
        /// Radius of the hole [m].
        inner_radius: f64,
        /// Radius of the outside [m].
        outer_radius: f64,
        /// Distance between bottom and top [m].
        height: f64,
        /// Cells around, across and along the axis.
        divisions: [usize; 3],
        /// Cells.
        cell: Option<Cell>,
    },
    /// A mesh that is given along with the scenario, read from a file.
    File {
        /// The file, for messages.
        file: String,
    },
    /// A mesh that is given along with the scenario, of somebody else's code.
    Given,
}

impl MeshSpec {
    /// The kind, as the case file names it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            MeshSpec::Disc { .. } => "disc",
            MeshSpec::Rectangle { .. } => "rectangle",
            MeshSpec::Ring { .. } => "ring",
            MeshSpec::Box { .. } => "box",
            MeshSpec::Ball { .. } => "ball",
            MeshSpec::Cylinder { .. } => "cylinder",
            MeshSpec::Tube { .. } => "tube",
            MeshSpec::File { .. } => "file",
            MeshSpec::Given => "given",
        }
    }
}
