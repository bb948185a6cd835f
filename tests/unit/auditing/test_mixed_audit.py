"""Wedges, and bodies of cells of several kinds, are audited."""

import pytest
from refuting import confirmed, refuted_after

import carom
from tampered import in_case, in_h5, little_more

RUBBER = {"kind": "neo-hookean", "young": 3e3, "poisson": 0.3, "density": 1.0}

SPACE = {1: ("C3D8", "C3D6"), 2: ("C3D20", "C3D15")}
PLANE = {1: ("CPE4", "CPE3"), 2: ("CPE8", "CPE6")}
CUBE_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
CUBE_EDGES += [(0, 4), (1, 5), (2, 6), (3, 7)]
WEDGE_EDGES = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)]
SQUARE_EDGES, TRIANGLE_EDGES = CUBE_EDGES[:4], WEDGE_EDGES[:3]


class Deck:
    """A box of unit cells whose right half is cut in two, as an Abaqus deck."""

    def __init__(self, size, degree):
        self._numbers, self._degree = {}, degree
        whole, halves = [], []
        for i in range(size[0]):
            for j in range(size[1]):
                for k in range(size[2] if len(size) == 3 else 1):
                    low = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    heights = (k, k + 1) if len(size) == 3 else (0,)
                    cut = [low] if i < size[0] // 2 else [low[:3], [low[0], *low[2:]]]
                    kinds = whole if len(cut) == 1 else halves
                    kinds += [[(*at, z) for z in heights for at in part] for part in cut]
        space = len(size) == 3
        edges = (CUBE_EDGES, WEDGE_EDGES) if space else (SQUARE_EDGES, TRIANGLE_EDGES)
        parts = [
            [self._nodes(cell, own) for cell in cells]
            for cells, own in zip((whole, halves), edges, strict=True)
        ]
        lines = ["*NODE"]
        for (x, y, z), number in self._numbers.items():
            # Nothing is at right angles.
            at = [0.3 * x + 0.02 * y, 0.3 * y + 0.03 * z, 0.3 * z - 0.01 * x]
            lines.append(", ".join(map(repr, [number, *at[: len(size)]])).replace("'", ""))
        first = 1
        for kind, cells in zip((SPACE if space else PLANE)[degree], parts, strict=True):
            lines.append(f"*ELEMENT, TYPE={kind}, ELSET={'whole' if kind[-1] in '480' else 'cut'}")
            for number, nodes in enumerate(cells, start=first):
                numbers = list(map(str, [number, *nodes]))
                lines += [", ".join(numbers[:10]) + ("," if len(numbers) > 10 else "")]
                lines += [", ".join(numbers[10:])] if len(numbers) > 10 else []
            first += len(cells)
        lines += ["*ELSET, ELSET=stiff", "cut"]
        self.text = "\n".join(lines) + "\n"

    def _nodes(self, cell, edges):
        if self._degree == 2:
            cell = [
                *cell,
                *(
                    tuple((p + q) / 2 for p, q in zip(cell[a], cell[b], strict=True))
                    for a, b in edges
                ),
            ]
        return [self._numbers.setdefault(at, len(self._numbers) + 1) for at in cell]


def thrown(mesh, dimension, method=("gap", "theta"), other=None, **body):
    """A body that is thrown on a block of quadrilaterals or hexahedra, and a floor."""
    condition, scheme = method
    flat = [0.0] * (dimension - 1)
    block = {
        "kind": "rectangle" if dimension == 2 else "box",
        "corner": [*[0.0, -0.17][: dimension - 1], -0.6],
        "size": [1.7] + [0.8] * (dimension - 2) + [0.6],
        "divisions": [4] + [2] * (dimension - 2) + [2],
    }
    return carom.Scenario.from_dict(
        {
            "dimension": dimension,
            "analysis": {
                "end_time": 0.004,
                "time_step": 2e-3,
                "gravity": [*flat, -9.81],
                "scheme": {"kind": scheme},
            },
            "materials": {
                "m": {**RUBBER, "damping": {"mass": 0.1, "stiffness": 1e-4}},
                "n": {**RUBBER, "young": 4e3, "damping": {"mass": 0.1, "stiffness": 1e-4}},
            },
            "bodies": [
                {
                    "name": "mixed",
                    "material": "m",
                    "mesh": mesh,
                    "velocity": [0.5, *flat[1:], -4.0],
                    **body,
                },
                {"name": "block", "material": "m", "mesh": block, **(other or {})},
            ],
            "obstacles": [
                {
                    "kind": "plane",
                    "name": "floor",
                    "point": [*flat, -0.605],
                    "normal": [*flat, 1.0],
                }
            ],
            "contact": {"condition": condition, "friction": 0.3, "penetration_tolerance": 0.5},
            "output": {"audit": True, "history_every": 2e-3, "fields_every": 4e-3},
        }
    )


def run_confirmed(case, directory):
    result = carom.run(case, out=directory)
    assert result.summary["pairs"][0]["has_touched"]
    checks = confirmed(directory)
    assert checks["Coulomb: cone"].count > 1
    assert checks["contact gaps"].figure < 1e-9
    return checks


WEDGES = {"kind": "box", "corner": [0, 0, 0.001], "size": [1, 0.6, 0.6], "divisions": [2, 2, 2]}


@pytest.mark.parametrize(
    ("cell", "method", "body"),
    [
        ("wedge6", ("massless", "conserving"), {"mass": "lumped"}),
        ("wedge15", ("gap", "conserving"), {"mass": "lumped"}),
    ],
)
def test_wedges_are_confirmed(tmp_path, cell, method, body):
    divisions = [3, 3, 3] if method[0] == "massless" else [2, 1, 1]
    mesh = {**WEDGES, "cell": cell, "divisions": divisions}
    run_confirmed(thrown(mesh, 3, method, **body), tmp_path)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A box of hexahedra and wedges, of which the wedges are stiff."""
    out = tmp_path_factory.mktemp("mixed")
    (out / "box.inp").write_text(Deck((2, 1, 1), 1).text)
    mesh = {"kind": "file", "file": str(out / "box.inp"), "move": [0.0, 0.0, 0.025]}
    regions = [{"material": "n", "on": "stiff"}]
    checks = run_confirmed(thrown(mesh, 3, regions=regions), out / "run")
    assert checks["materials"].count == 1 + 2 + 16
    return out / "run"


def test_mixed_cells_of_second_degree_are_confirmed(tmp_path):
    (tmp_path / "box.inp").write_text(Deck((2, 1, 1), 2).text)
    mesh = {"kind": "file", "file": str(tmp_path / "box.inp"), "move": [0.0, 0.0, 0.025]}
    run_confirmed(thrown(mesh, 3, ("midpoint", "conserving"), mass="lumped"), tmp_path / "run")


@pytest.mark.parametrize("degree", [1, 2])
def test_mixed_cells_of_the_plane_are_confirmed(tmp_path, degree):
    (tmp_path / "sheet.inp").write_text(Deck((4, 2), degree).text)
    mesh = {"kind": "file", "file": str(tmp_path / "sheet.inp"), "move": [0.0, 0.005]}
    body = {"hypothesis": "plane-stress", "thickness": 0.5, "mass": "lumped"}
    run_confirmed(thrown(mesh, 2, ("gap", "conserving"), **body), tmp_path / "run")


def test_mixed_cells_around_an_axis_are_confirmed(tmp_path):
    (tmp_path / "sheet.inp").write_text(Deck((4, 2), 1).text)
    mesh = {"kind": "file", "file": str(tmp_path / "sheet.inp"), "move": [0.1, 0.005]}
    around = {"hypothesis": "axisymmetric", "velocity": [0.0, -4.0]}
    case = thrown(mesh, 2, other={"hypothesis": "axisymmetric"}, **around)
    run_confirmed(case, tmp_path / "run")


CHANGED = [
    (in_h5("fields.vtkhdf:VTKHDF/CellData/stress", little_more), "stress"),
    (in_h5("fields.vtkhdf:VTKHDF/PointData/velocity", little_more), "kinetic energy"),
    (in_h5("audit.h5:steps/000000/end/contact_gap", little_more), "contact gaps"),
    (in_h5("audit.h5:steps/000000/end/contact_reaction", lambda r: 1.001 * r), "normal force"),
    (in_h5("surface.vtkhdf:VTKHDF/CellData/area", little_more), "surface: areas"),
    (in_h5("surface.vtkhdf:VTKHDF/CellData/pressure", little_more), "surface: pressure"),
]


def test_changed_numbers_of_a_mixed_body_are_found(run, tmp_path):
    def tamper(directory):
        for change, _ in CHANGED:
            change(directory)

    assert {found for _, found in CHANGED} <= refuted_after(run, tmp_path, tamper)


def test_another_material_of_the_wedges_is_found(run, tmp_path):
    tamper = in_case("young = 4000", "young = 4001")
    assert "equation of motion" in refuted_after(run, tmp_path, tamper)
