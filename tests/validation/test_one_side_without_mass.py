"""Massless contact where one side has its mass: rigid, reduced, or one cell across.

Pairs that have mass on both sides are ruled by the motion, as with the condition ``midpoint``.
The bounds are within ten times of what is measured; defects are of the energy at the start.
"""

import h5py
import numpy as np
import pytest

import carom
from carom.doctor import examine

SOFT = {"kind": "saint-venant-kirchhoff", "young": 1e5, "poisson": 0.3, "density": 1000.0}
STIFF = {**SOFT, "young": 1e7}
FLOOR = {"name": "floor", "kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}


def disc(name, centre, velocity, **given):
    """Return a disc that deforms."""
    mesh = {"kind": "disc", "centre": centre, "radius": 0.5, "divisions": 8}
    return {"name": name, "material": "own", "mesh": mesh, "velocity": velocity, **given}


def block(name, corner, size, divisions, velocity, **given):
    """Return a rectangle that deforms."""
    mesh = {"kind": "rectangle", "corner": corner, "size": size, "divisions": divisions}
    return {"name": name, "material": "own", "mesh": mesh, "velocity": velocity, **given}


def rigid(body):
    """Return the same body without a material."""
    return {**{k: v for k, v in body.items() if k != "material"}, "kind": "rigid", "density": 1e3}


def ball(name, centre, velocity, **given):
    """Return a ball that deforms."""
    mesh = {"kind": "ball", "centre": centre, "radius": 0.5, "divisions": 4}
    return {"name": name, "material": "own", "mesh": mesh, "velocity": velocity, **given}


def stepped(bodies, *, end, dt=1e-3, condition="massless", friction=0.3, **given):
    """Run a case, every step recorded, and return the history."""
    simulation = carom.Simulation(scenario(bodies, end, dt, condition, friction, **given))
    while simulation.time < end * (1 - 1e-9):
        simulation.step()
    return simulation.history


def scenario(bodies, end, dt, condition, friction, *, gravity=None, material=SOFT, **given):
    """Return a case."""
    return carom.Scenario.from_dict(
        {
            "dimension": len(bodies[0]["velocity"]),
            "analysis": {"end_time": end, "time_step": dt, "gravity": gravity},
            "output": {"fields_every": end, "history_every": dt},
            "materials": {"own": material},
            "bodies": bodies,
            "contact": {"condition": condition, "friction": friction},
            **given,
        }
    )


BOX = rigid(block("a", [-0.5, 0.02], [1.0, 0.3], [4, 2], [0.0, 0.0]))
SPINNING = [
    rigid(disc("a", [0.0, 0.0], [0.5, 0.0], spin=3.0)),
    disc("b", [1.05, 0.3], [-2.0, 0.0], spin=-2.0),
]
BETWEEN = [
    rigid(disc("a", [0.0, 0.0], [0.0, 0.0])),
    disc("b", [1.05, 0.1], [-2.0, 0.0]),
    disc("c", [-1.05, 0.05], [1.0, 0.0]),
]
PLATE = [
    block("a", [0.0, 0.0], [2.0, 0.2], [10, 1], [0.0, 0.0]),
    disc("b", [1.0, 0.75], [0.4, -2.0]),
]
REDUCED = [
    {
        **block("a", [0.0, 0.0], [2.0, 0.4], [12, 3], [0.0, 0.0]),
        **{"kind": "reduced", "modes": 8, "contact_sets": ["top"]},
    },
    disc("b", [1.3, 0.95], [0.2, -1.0]),
]
IN_SPACE = [
    rigid(ball("a", [0.0, 0.0, 0.0], [0.0, 0.0, 0.0], spin=[0.0, 0.0, 4.0])),
    ball("b", [1.05, 0.3, 0.1], [-5.0, 0.0, 0.0], spin=[0.0, 1.0, 0.0]),
]
FREE = {
    "rigid disc": (SPINNING, {"end": 0.4}),
    "rigid disc between two": (BETWEEN, {"end": 0.4}),
    "plate of one cell": (PLATE, {"end": 0.4}),
    "reduced beam": (REDUCED, {"end": 0.2, "dt": 5e-4}),
    "rigid ball": (IN_SPACE, {"end": 0.05, "dt": 5e-4, "material": STIFF}),
}


@pytest.mark.parametrize("friction", [0.0, 0.3])
@pytest.mark.parametrize("kind", FREE)
def test_energy_and_momenta_are_kept(kind, friction):
    bodies, given = FREE[kind]
    history = stepped(bodies, friction=friction, **given)
    start = history["total"][0]
    assert np.abs(history["defect"]).max() < 1e-13 * start
    assert np.max(history["normal_force"]) > 0.0
    assert (history["friction"][-1] > 1e-4 * start) == (friction > 0.0)
    assert np.all(np.diff(history["friction"]) >= -1e-12 * start)
    momenta = [np.asarray(history[name]) for name in history if "momentum" in name]
    size = max(np.abs(momentum).max() for momentum in momenta)
    # The moment of forces on a reduced body is that about axes that turn with it, to second order.
    kept = [1e-12, 1e-12, 1e-8] if kind == "reduced beam" else [5e-10] * len(momenta)
    assert len(kept) == len(momenta)
    for momentum, bound in zip(momenta, kept, strict=True):
        assert np.ptp(momentum) < bound * size


def test_a_rigid_body_is_met_without_chatter_and_without_penetration():
    """One impact loads the contact once: its force rises and falls, and that is all."""
    bodies = [rigid(disc("a", [0.0, 0.0], [0.0, 0.0])), disc("b", [1.05, 0.3], [-2.0, 0.0])]

    def variation(condition):
        history = stepped(bodies, end=0.4, condition=condition)
        force = np.asarray(history["normal_force"])
        return np.abs(np.diff(force)).sum() / force.max(), np.nanmin(history["min_gap"])

    quiet, gap = variation("massless")
    assert quiet < 2.5 and gap > -1e-10
    loud, _ = variation("midpoint")
    assert loud > 20.0


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_pairs_with_and_without_mass_share_a_case(friction):
    """A rigid box on the floor, which both have mass, and a disc that falls on it."""
    bodies = [BOX, disc("b", [0.0, 0.85], [0.2, -1.0])]
    history = stepped(
        bodies,
        end=0.5,
        friction=friction,
        material=STIFF,
        gravity=[0.0, -9.81],
        obstacles=[FLOOR],
    )
    start = history["total"][0]
    assert np.abs(history["defect"]).max() < 2e-13 * start
    assert (history["friction"][-1] > 1e-2 * start) == (friction > 0.0)
    assert history["a.y"][-1] > 0.14


def struck_bar(cells, condition="massless"):
    """Return the errors of the striker's velocity and of the late force on a bar that it strikes.

    A rigid mass M that strikes a bar at v₀ sends a wave into it, and is slowed down by the force
    F = ρcA v: v = v₀ exp(−ρcA t/M), until that wave is back at t = 2L/c (Saint-Venant; Goldsmith,
    Impact, 1960, section 2.2). Here L = c = 1, M a quarter of the mass of the bar.
    """
    mass, speed, area = 0.025, 1e-3, 0.1
    striker = {
        "name": "striker",
        "kind": "rigid",
        "mass": mass,
        "mesh": {
            "kind": "rectangle",
            "corner": [-0.2, 0.0],
            "size": [0.2, area],
            "divisions": [2, 1],
        },
        "velocity": [speed, 0.0],
        "contact_sets": ["right"],
    }
    bar = block("bar", [0.0, 0.0], [1.0, area], [cells, 1], [0.0, 0.0], contact_sets=["left"])
    elastic = {"kind": "linear-elastic", "young": 1.0, "poisson": 0.0, "density": 1.0}
    history = stepped(
        [striker, bar],
        end=1.2,
        dt=0.25 / cells,
        condition=condition,
        friction=0.0,
        material=elastic,
    )
    time = np.asarray(history["time"])
    exact = np.exp(-area * time / mass)
    late = (time > 0.1) & (time < 1.1)
    velocity = np.abs(history["striker.v_x"] / speed - exact).max()
    force = np.abs(history["normal_force"] / (area * speed) - exact)[late].max()
    return velocity, force


def test_a_rigid_mass_that_strikes_a_bar_is_slowed_down_as_saint_venant_says():
    coarse, fine = struck_bar(50), struck_bar(200)
    assert fine[0] < 1.5e-2 and coarse[0] > 3.5 * fine[0]
    assert fine[1] < 4e-2 and coarse[1] > 5.0 * fine[1]
    assert struck_bar(200, "midpoint")[1] > 0.3


LAW = {"static": 0.6, "kinetic": 0.3}
KEEP_MASS = {
    "all rigid": ([rigid(disc("a", [0.0, 0.55], [1.0, -1.0]))], {}),
    "friction law": ([block("a", [-0.5, 0.0], [1.0, 0.3], [6, 4], [1.0, 0.0])], {"friction": LAW}),
    "one cell": ([block("a", [-0.5, 0.0], [1.0, 0.3], [6, 1], [1.0, -1.0])], {}),
    "mass on its surface": (
        [block("a", [-0.5, 0.0], [1.0, 0.3], [6, 4], [1.0, -1.0])],
        {"masses": [{"body": "a", "on": "top", "mass": 10.0}]},
    ),
    "spring on its surface": (
        [block("a", [-0.5, 0.0], [1.0, 0.3], [6, 4], [1.0, -1.0])],
        {
            "springs": [
                {
                    "name": "s",
                    "between": [{"body": "a", "on": "top"}, {"point": [0, 1]}],
                    "stiffness": 1e4,
                }
            ]
        },
    ),
}


@pytest.mark.parametrize("kind", KEEP_MASS)
def test_what_keeps_its_mass_meets_obstacles_as_midpoint_says(kind):
    bodies, given = KEEP_MASS[kind]
    runs = [
        stepped(
            bodies,
            end=0.1,
            material=STIFF,
            gravity=[0.0, -9.81],
            obstacles=[FLOOR],
            condition=condition,
            **given,
        )
        for condition in ("massless", "midpoint")
    ]
    assert np.max(runs[0]["normal_force"]) > 0.0
    for name in ("total", "friction", "a.y", "normal_force"):
        assert np.array_equal(runs[0][name], runs[1][name])


AUDITED = {
    "rigid disc": (SPINNING, {}),
    "rigid disc between two": (BETWEEN, {"friction": 0.0}),
    "plate of one cell": (PLATE, {}),
    "box on a floor": (
        [BOX, disc("b", [0.0, 0.85], [0.2, -1.0])],
        {"material": STIFF, "gravity": [0.0, -9.81], "obstacles": [FLOOR]},
    ),
}


def audited(tmp_path, bodies, friction=0.3, **given):
    """Run a case whose steps are stored, and return where."""
    case = scenario(bodies, 0.4, 1e-3, "massless", friction, **given)
    stored = carom.Output(fields_every=0.02, history_every=1e-3, audit=True)
    directory = tmp_path / "run"
    carom.run(case.model_copy(update={"output": stored}), out=directory)
    return directory


@pytest.mark.parametrize("kind", AUDITED)
def test_the_audit_confirms_what_has_mass_beside_what_has_none(tmp_path, kind):
    bodies, given = AUDITED[kind]
    audit = carom.audit(audited(tmp_path, bodies, **given))
    assert [str(check) for check in audit.refuted] == []


def test_the_audit_notices_reactions_that_a_rigid_body_did_not_take(tmp_path):
    """Its velocities are those of 0.1 % more of the impulse."""
    directory = audited(tmp_path, SPINNING)
    with h5py.File(directory / "audit.h5", "r+") as file:
        pressed = [step for step in file["steps"].values() if len(step["end/contact_node"])]
        velocity, start = (pressed[-1][f"{end}/velocity"] for end in ("end", "start"))
        nodes = velocity.shape[0] // 2  # the rigid disc, which comes first
        velocity[:nodes] = velocity[:nodes] + 1e-3 * (velocity[:nodes] - start[:nodes])
    refuted = {check.name for check in carom.audit(directory).refuted}
    assert "impulse" in refuted


def test_rigid_bodies_alone_are_audited_as_what_they_are_ruled_by(tmp_path):
    bodies, _ = KEEP_MASS["all rigid"]
    case = scenario(bodies, 0.1, 1e-3, "massless", 0.3, obstacles=[FLOOR])
    carom.run(case, out=tmp_path / "run")
    assert carom.audit(tmp_path / "run").confirmed


def test_the_doctor_says_who_keeps_the_mass():
    case = scenario(BETWEEN, 0.1, 1e-3, "massless", 0.3)
    said = [finding.what for finding in examine(case).findings]
    assert any("keeping their mass where they touch: a;" in what for what in said)
