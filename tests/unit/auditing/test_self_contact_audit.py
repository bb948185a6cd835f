"""Bodies that touch themselves are audited."""

import pytest
from refuting import confirmed, refuted_after

import carom
from tampered import in_case, in_csv, in_h5, little_more

ACROSS, UP = [0.0, 0.2, 0.25, 0.3, 0.35, 0.55], [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
DEEP = [0.0, 0.15, 0.3]


def fork(path, dimension, fine=1):
    """Write two prongs on a foot, whose insides are not parallel, with sets of their nodes."""
    numbers, cells = {}, []
    across = [x for k, a in enumerate(ACROSS[:-1]) for x in _between(a, ACROSS[k + 1], fine)]
    up = [y for k, a in enumerate(UP[:-1]) for y in _between(a, UP[k + 1], fine)]
    across, up = [*across, ACROSS[-1]], [*up, UP[-1]]

    def node(i, j, k):
        return numbers.setdefault((i, j, k), len(numbers) + 1)

    for k in range(1 if dimension == 2 else 2):
        for i in range(len(across) - 1):
            for j in range(len(up) - 1):
                if j < fine or i < fine or i >= 4 * fine:
                    ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    planes = [k] if dimension == 2 else [k, k + 1]
                    cells.append([node(*at, z) for z in planes for at in ring])
    lines = ["*NODE"]
    for (i, j, k), number in numbers.items():
        x, y = across[i], up[j]
        # The right prong leans out, the left one has its nodes higher.
        place = [x + 0.02 * y * (x > 0.3), y + 0.05 * x * (x <= 0.2), DEEP[k]][:dimension]
        lines.append(", ".join(map(str, [number, *place])))
    lines.append(f"*ELEMENT, TYPE={'CPE4' if dimension == 2 else 'C3D8'}, ELSET=cells")
    lines += [", ".join(map(str, [n, *nodes])) for n, nodes in enumerate(cells, start=1)]
    last, high = len(across) - 1, len(up) - 1 - fine
    tip = [str(n) for (i, j, _), n in numbers.items() if i == last and j >= high]
    foot = [str(n) for (i, j, _), n in numbers.items() if i <= fine and j == 0]
    for name, nodes in (("tip", tip), ("foot", foot)):
        lines.append(f"*NSET, NSET={name}")
        lines += [", ".join(nodes[k : k + 8]) for k in range(0, len(nodes), 8)]
    path.write_text("\n".join(lines) + "\n")


def _between(a, b, count):
    return [a + (b - a) * k / count for k in range(count)]


def pinched(path, dimension, method, *, ball=False, **body):
    """A fork whose right prong is pushed against the left one, and perhaps a ball on its way."""
    condition, scheme = method
    analysis = {"end_time": 0.09, "time_step": 5e-3}
    analysis["scheme"] = {"kind": scheme}
    if scheme == "static":
        analysis = {"kind": "static", "end_time": 0.11, "time_step": 0.01}
    mesh = {"kind": "disc", "centre": [0.09, 1.13], "radius": 0.1, "divisions": 2}
    return carom.Scenario.from_dict(
        {
            "dimension": dimension,
            "analysis": analysis,
            "materials": {
                "m": {
                    "kind": "saint-venant-kirchhoff",
                    "young": 2e4,
                    "poisson": 0.3,
                    "density": 10.0,
                    "damping": {"mass": 0.5, "stiffness": 1e-4},
                }
            },
            "bodies": [
                {
                    "name": "fork",
                    "material": "m",
                    "mesh": {"kind": "file", "file": str(path)},
                    **body,
                },
                *([{"name": "ball", "material": "m", "mesh": mesh}] if ball else []),
            ],
            "motions": [
                {"kind": "fixed", "body": "fork", "on": "foot"},
                {"kind": "prescribed", "body": "fork", "on": "tip", "x": "-2.5*t"},
            ],
            "contact": {"condition": condition, "friction": 0.3, "penetration_tolerance": 0.5},
            "output": {"audit": True, "history_every": analysis["time_step"], "fields_every": 0.01},
        }
    )


def run_confirmed(case, directory):
    result = carom.run(case, out=directory)
    assert ["fork", "fork"] in [pair["between"] for pair in result.summary["pairs"]]
    checks = confirmed(directory)
    assert checks["contact gaps"].figure < 1e-9
    assert checks["Coulomb: slip"].count >= 1
    return checks


METHODS = [("midpoint", "conserving"), ("endpoint", "theta"), ("gap", "static")]


@pytest.mark.filterwarnings("ignore:analysis.time_step")
@pytest.mark.parametrize("method", METHODS)
def test_prongs_that_touch_one_another_are_confirmed(tmp_path, method):
    fork(tmp_path / "fork.inp", 2)
    run_confirmed(pinched(tmp_path / "fork.inp", 2, method), tmp_path / "run")


@pytest.mark.filterwarnings("ignore:analysis.time_step")
def test_prongs_in_space_are_confirmed(tmp_path):
    fork(tmp_path / "fork.inp", 3)
    run_confirmed(pinched(tmp_path / "fork.inp", 3, ("gap", "theta")), tmp_path / "run")


@pytest.mark.filterwarnings("ignore:analysis.time_step")
@pytest.mark.filterwarnings("ignore:the ledger missed")
def test_prongs_without_mass_where_they_touch_are_confirmed(tmp_path):
    fork(tmp_path / "fork.inp", 2, fine=3)
    case = pinched(tmp_path / "fork.inp", 2, ("massless", "conserving"), self_contact=True)
    checks = run_confirmed(case, tmp_path / "run")
    assert checks["massless nodes"].count > 0


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A fork on whose left prong a ball lies besides."""
    out = tmp_path_factory.mktemp("fork")
    fork(out / "fork.inp", 2)
    with pytest.warns(carom.CaromWarning, match="time_step"):
        run_confirmed(pinched(out / "fork.inp", 2, ("gap", "theta"), ball=True), out / "run")
    return out / "run"


def test_changed_numbers_of_a_body_that_touches_itself_are_found(run, tmp_path):
    step = "audit.h5:steps/000006"
    changes = [
        (in_h5(f"{step}/end/contact_gap", little_more), "contact gaps"),
        (in_h5(f"{step}/end/contact_reaction", lambda r: 1.001 * r), "normal force"),
        (in_csv("history.csv", "friction"), "ledger in history"),
        (in_h5("surface.vtkhdf:VTKHDF/CellData/pressure", little_more), "surface: pressure"),
    ]

    def tamper(directory):
        for change, _ in changes:
            change(directory)

    assert {found for _, found in changes} <= refuted_after(run, tmp_path, tamper)


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("friction = 0.3", "friction = 0.301", "Coulomb: slip"),
        ('name = "fork"', 'name = "fork"\nself_contact = false', "pairs"),
    ],
)
def test_another_case_of_a_body_that_touches_itself_is_found(run, tmp_path, old, new, found):
    assert found in refuted_after(run, tmp_path, in_case(old, new))
