"""Bodies of another code among the bodies of a scenario: a run of them is a run like any other."""

import re

import numpy as np
import pytest

import carom
from carom._carom import Simulation
from carom.auditing import audit
from carom.mesh_file import MeshArrays
from foreign_case import foreign_bodies, with_bodies
from grazing_discs import discs

CORNERS = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
SIDES = [[0, 1], [1, 2], [2, 3], [3, 0]]


def spring(name="square", **kwargs):
    """Four masses of a square on springs to their places."""
    arguments = {
        "mass": np.eye(8),
        "energy": lambda u: 50.0 * u @ u,
        "force": lambda u: 100.0 * u,
        "stiffness": lambda u: 100.0 * np.eye(8),
        "velocity": [0.0, -1.0],
        "cells": {"quad": [[0, 1, 2, 3]]},
    }
    return carom.ForeignBody(name, CORNERS, SIDES, **(arguments | kwargs))


def free(name="square", **kwargs):
    """The square without springs."""
    nothing = {
        "energy": lambda u: 0.0,
        "force": lambda u: 0.0 * u,
        "stiffness": lambda u: np.zeros((8, 8)),
    }
    return spring(name, **(nothing | kwargs))


def scenario(*bodies, steps=10, time_step=1e-2, **kwargs):
    """A case of bodies."""
    analysis = carom.Dynamic(end_time=steps * time_step, time_step=time_step)
    return carom.Scenario(**({"analysis": analysis, "bodies": bodies} | kwargs))


def test_beside_a_body_of_carom_it_moves_as_one_of_carom_does(tmp_path):
    """Nothing but the code that assembles forces is another: rows, books, events."""
    case = discs(150)
    foreign = with_bodies(case, [foreign_bodies(case)[0], case.bodies[1]])
    by_carom, by_other = (
        carom.run(each, out=tmp_path / name) for each, name in ((case, "own"), (foreign, "foreign"))
    )
    assert by_other.history.keys() == by_carom.history.keys()
    for column, values in by_carom.history.items():
        if column.endswith(("residual", "iterations")):
            continue
        size = max(np.abs(values[np.isfinite(values)]).max(initial=0.0), 1e-3)
        difference = np.abs(by_other.history[column] - values)
        assert np.nanmax(difference) < 1e-9 * size, column
    ours, theirs = by_carom.summary["contacts"], by_other.summary["contacts"]
    assert [c["pair"] for c in theirs] == [c["pair"] for c in ours]
    assert theirs[0]["friction_work"] == pytest.approx(ours[0]["friction_work"], rel=1e-9)
    assert by_other.summary["status"] == "completed"
    certificate = by_other.summary["certificate"]
    assert certificate["max_joule"] <= certificate["tolerance_joule"]


def test_its_results_are_read_and_reported_as_those_of_others(tmp_path):
    result = carom.run(
        scenario(spring(), output=carom.Output(report=True, checkpoint_every=0.01)), out=tmp_path
    )
    assert (tmp_path / "report.html").exists()
    assert not list(tmp_path.glob("*checkpoint*"))
    assert not (tmp_path / "end_state.h5").exists()
    opened = carom.Result.open(tmp_path)
    assert opened.fields["displacement"].shape[1:] == (4, 2)
    assert result.scenario.bodies[0].kind == "foreign"
    assert "square" in repr(opened.scenario.bodies[0])


def test_a_rigid_body_and_an_elastic_one_meet_it_and_the_books_close(tmp_path):
    """All three kinds, massless contact of the elastic one, friction and gravity."""
    case = discs(1)
    elastic = case.bodies[0].model_copy(
        update={
            "velocity": (0.0, -1.0),
            "mesh": carom.Disc(centre=[0.5, 2.04], radius=1, divisions=4),
        }
    )
    stiff = free(
        energy=lambda u: 0.5 * u @ stiffness @ u,
        force=lambda u: stiffness @ u,
        stiffness=lambda u: stiffness,
        velocity=[0.0, 0.0],
        fixed=np.repeat(CORNERS[:, 1:] < 0.5, 2, axis=1),
    )
    stiffness = 500.0 * np.eye(8)
    rigid = carom.RigidBody(
        name="hard",
        density=2.0,
        mesh=carom.Rectangle(corner=[1.6, 1.9], size=[0.5, 0.5], divisions=[1, 1]),
        velocity=[-1.5, 0.0],
    )
    result = carom.run(
        scenario(
            stiff,
            elastic,
            rigid,
            steps=300,
            time_step=1e-3,
            materials=case.materials,
            analysis=carom.Dynamic(end_time=0.3, time_step=1e-3, gravity=[0.0, -9.81]),
            contact=carom.Contact(friction=0.3),
        ),
        out=tmp_path,
    )
    met = {tuple(sorted(contact["pair"])) for contact in result.summary["contacts"]}
    assert ("left", "square") in met
    assert ("hard", "left") in met
    energy = result.summary["energy"]
    assert energy["max_defect"] < 1e-10 * energy["initial"]
    assert energy["friction"] > 1e-3
    assert result.summary["status"] == "completed"


def test_it_falls_as_others_do(tmp_path):
    """Closed form: it falls by ½ g t², and gravity works m g h."""
    analysis = carom.Dynamic(end_time=0.1, time_step=1e-2, gravity=[0.0, -10.0])
    history = carom.run(scenario(free(velocity=None), analysis=analysis), out=tmp_path).history
    fallen = 0.5 * 10.0 * history["time"] ** 2
    assert history["square.y"] == pytest.approx(0.5 - fallen, abs=1e-13)
    assert history["external"] == pytest.approx(4.0 * 10.0 * fallen, abs=1e-12)
    assert np.abs(history["defect"]).max() < 1e-13


def test_what_is_fixed_stays_and_the_rest_swings(tmp_path):
    """Closed form: two masses of 1 kg on springs of 100 N/m swing with ω = 10."""
    fixed = np.repeat(CORNERS[:, 1:] > 0.5, 2, axis=1)
    case = scenario(spring(fixed=fixed), steps=200, time_step=1e-3)
    result = carom.run(case, out=tmp_path)
    moved = result.fields["displacement"][-1]
    assert (moved[2:] == 0.0).all()
    assert moved[:2, 1] == pytest.approx(-np.sin(10.0 * 0.2) / 10.0, rel=1e-4)
    assert result.history["total"][0] == pytest.approx(1.0, rel=1e-14)


def test_in_space_it_has_the_momenta_and_energies_of_its_mass(tmp_path):
    """Closed form: ω × r of eight masses of a cube; J = Σ m (r² I − r rᵀ)."""
    corners = np.array(np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0, 1.0], indexing="ij"))
    points = corners.reshape(3, 8).T
    masses, spin, drift = np.arange(1.0, 9.0), np.array([1.0, -2.0, 0.5]), np.array([3.0, 0.0, 1.0])
    centre = masses @ points / masses.sum()
    arms = points - centre
    sides = [[0, 2, 6, 4], [1, 5, 7, 3], [0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6]]
    body = carom.ForeignBody(
        "cube",
        points,
        sides,
        mass=np.diag(np.repeat(masses, 3)),
        energy=lambda u: 0.0,
        force=lambda u: 0.0 * u,
        stiffness=lambda u: np.zeros((24, 24)),
        velocity=drift + np.cross(spin, arms),
        cells={"hexahedron": [[0, 4, 6, 2, 1, 5, 7, 3]]},
    )
    history = carom.run(scenario(body, dimension=3, steps=1), out=tmp_path).history
    inertia = sum(
        m * (r @ r * np.eye(3) - np.outer(r, r)) for m, r in zip(masses, arms, strict=True)
    )
    about = masses.sum() * np.cross(centre, drift) + inertia @ spin
    for axis, name in enumerate("xyz"):
        assert history[f"cube.{name}"][0] == pytest.approx(centre[axis], rel=1e-13)
        assert history[f"cube.v_{name}"][0] == pytest.approx(drift[axis], abs=1e-13)
        assert history[f"cube.spin_{name}"][0] == pytest.approx(spin[axis], rel=1e-12)
        assert history[f"momentum_{name}"][0] == pytest.approx(36.0 * drift[axis], abs=1e-12)
        assert history[f"angular_momentum_{name}"][0] == pytest.approx(about[axis], rel=1e-12)
    kinetic = 0.5 * 36.0 * drift @ drift + 0.5 * spin @ inertia @ spin
    assert history["kinetic"][0] == pytest.approx(kinetic, rel=1e-13)


def fails(u):
    if np.abs(u).max() > 0.0205:
        raise RuntimeError("no convergence of the plastic strain")
    return 100.0 * u


def test_a_law_that_raises_fails_the_step_and_what_there_is_is_kept(tmp_path):
    with pytest.raises(carom.ConvergenceError, match="no convergence of the plastic") as raised:
        carom.run(scenario(spring(force=fails)), out=tmp_path)
    assert isinstance(raised.value.__cause__, RuntimeError)
    summary = carom.Result.open(tmp_path).summary
    assert summary["status"] == "failed"
    assert (
        "a body of another code, or the engine, raised RuntimeError: no convergence"
        in summary["reason"]
    )
    assert summary["steps"] == 2


def test_a_step_that_a_law_refuses_is_taken_in_shorter_ones(tmp_path):
    """A code that cannot take long steps is given short ones, and its refusal is forgotten."""
    here = [np.zeros(8)]

    def careful(u):
        if np.abs(u - here[0]).max() > 4e-3:
            raise ValueError("too far")
        here[0] = u
        return 100.0 * u

    result = carom.run(scenario(spring(force=careful), steps=2), out=tmp_path)
    assert result.summary["status"] == "completed"
    assert result.summary["retried_steps"] >= 1


def test_ctrl_c_within_a_law_interrupts_the_run(tmp_path):
    def interrupted(u):
        if np.abs(u).max() > 0.0205:
            raise KeyboardInterrupt
        return 100.0 * u

    with pytest.raises(KeyboardInterrupt):
        carom.run(scenario(spring(force=interrupted)), out=tmp_path)
    assert carom.Result.open(tmp_path).summary["status"] == "interrupted"


@pytest.mark.parametrize(
    ("bodies", "given", "message"),
    [
        (
            [spring(cells=None)],
            {},
            "bodies.square.cells: are missing; in a scenario a body is drawn",
        ),
        (
            [spring(cells={"quads": [[0, 1, 2, 3]]})],
            {},
            "'quads' is no kind of cell in 2D; did you",
        ),
        ([spring(cells={"quad": [[0, 1, 2]]})], {}, "'quad' has shape [1, 3] and type int64; must"),
        (
            [spring(cells={"triangle": [[0, 1, 2]]})],
            {},
            "cells: have 3 of the 4 points; give every",
        ),
        ([spring(cells={"quad": [[0, 2, 1, 3]]})], {}, "bodies.square.cells:"),
        ([spring(mass=-np.eye(8))], {}, 'the mass of body "square" is not positive definite'),
        ([spring(stiffness=lambda u: np.eye(3))], {}, "bodies.square.stiffness: has shape [3, 3]"),
        ([spring(force=lambda u: u + np.nan)], {}, "bodies.square.force: returned nan at [0]"),
        ([spring()], {"dimension": 3}, "bodies.0: 'square' is a body in 2D; set dimension = 2"),
        (
            [spring()],
            {"analysis": carom.Static(end_time=1.0, time_step=0.5)},
            'body "square" is of another code, which takes no load steps; make the analysis',
        ),
        (
            [spring()],
            {"loads": [carom.Force(body="square", on="all", force=[0.0, 1.0])]},
            'loads.0.body: body "square" is of another code: gravity and contacts are all',
        ),
        (
            [spring()],
            {"motions": [carom.Fixed(body="square", on="all")]},
            'motions.0.body: body "square" is of another code: gravity and contacts are all',
        ),
        (
            [spring()],
            {
                "springs": [
                    carom.Spring(
                        name="s",
                        stiffness=1.0,
                        between=[{"body": "square", "point": [0.0, 0.0]}, {"point": [0.0, -1.0]}],
                    )
                ]
            },
            'body "square" is of another code: gravity and contacts are all',
        ),
        (
            [spring()],
            {"masses": [carom.PointMass(body="square", point=[0.0, 0.0], mass=1.0)]},
            'masses.0.body: body "square" is of another code, which has all of its mass',
        ),
        (
            [spring()],
            {"initial": carom.Initial(result="elsewhere", time=1.0)},
            "initial: a case with a body of another code starts as drawn",
        ),
    ],
)
def test_what_cannot_be_is_refused_before_anything_is_written(tmp_path, bodies, given, message):
    out = tmp_path / "out"
    with pytest.raises(carom.InputError, match=re.escape(message)):
        carom.run(scenario(*bodies, **given), out=out)
    assert not out.exists()


def test_a_case_with_stages_is_refused(tmp_path):
    stage = carom.Stage(name="s", analysis=carom.Dynamic(end_time=0.1, time_step=0.01))
    with pytest.raises(carom.InputError, match="is of another code, which knows of no stages"):
        carom.run(carom.Scenario(bodies=[spring()], stages=[stage]), out=tmp_path / "out")


def test_no_file_holds_its_law(tmp_path):
    """Neither a case file nor a run goes on with it; the auditor is given it again."""
    case = scenario(spring())
    (tmp_path / "case.toml").write_text(case.to_toml())
    again = carom.Scenario.from_toml(tmp_path / "case.toml")
    with pytest.raises(
        carom.InputError, match="is of another code, and no file holds its law; put"
    ):
        carom.run(again, out=tmp_path / "out")
    with pytest.raises(carom.InputError, match="no file holds its law"):
        carom.run(case.with_overrides(["contact.friction=0.3"]), out=tmp_path / "out")
    carom.run(case, out=tmp_path / "out")
    with pytest.raises(carom.InputError, match="a body of another code does not go on where it"):
        carom.run(case, out=tmp_path / "out", resume=True)
    assert any("its code alone knows" in left.what for left in audit(tmp_path / "out").unchecked)


def test_the_core_asks_for_cells_and_a_mass_that_go_together():
    """Python hands both over as one."""
    case = scenario(spring())
    foreign = {"square": case.bodies[0].code}
    with pytest.raises(carom.InputError, match="comes along with it; give its cells"):
        Simulation(case.to_json(), {}, {}, foreign)
    part = MeshArrays(
        points=CORNERS[:3],
        blocks=[("tri3", np.array([[0, 1, 2]]))],
        facet_sets={"contact": [np.array(SIDES[:2])]},
    )
    with pytest.raises(carom.InputError, match="is not that of the 3 nodes of its cells"):
        Simulation(case.to_json(), {"square": part}, {}, foreign)


def test_it_is_no_part_of_a_pattern():
    with pytest.raises(carom.InputError, match="foreign"):
        carom.Pattern(body=spring(), at=carom.Grid(counts=[2, 1], spacing=[2.0, 2.0]))


def test_both_feet_of_a_body_of_another_code_bear_alike_where_it_stands(tmp_path):
    """Symptom guarded against: 6.2 and 3.8 N, where round-off over round-off was a force."""
    body = spring(velocity=[0.3, -1.0], fixed=np.repeat(CORNERS[:, 1:] > 0.5, 2, axis=1))
    scenario = carom.Scenario(
        analysis=carom.Dynamic(end_time=0.2, time_step=1e-3, gravity=[1.0, -9.81]),
        bodies=[body],
        obstacles=[carom.Plane(name="floor", point=[0.0, -0.02], normal=[0.0, 1.0])],
        contact=carom.Contact(condition="gap", friction=0.3),
        output=carom.Output(fields_every=0.2, audit=True),
    )
    result = carom.run(scenario, out=tmp_path)
    left, right = result.fields["reaction"][-1][:2]
    # Measured: 3e-8, of the last steps in which it moved.
    assert np.abs(left - right).max() < 3e-7 * np.abs(left).max()
    assert not carom.audit(tmp_path, bodies=[body]).refuted
