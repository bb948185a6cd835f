"""Bodies of other codes are audited by their own code, and without it as far as that goes."""

import re
from copy import copy

import numpy as np
import pytest
from lattice import Lattice
from refuting import confirmed, refuted_after
from typer.testing import CliRunner

import carom
from carom import cli
from carom.auditing.bodies.foreign import ForeignBody
from carom.auditing.steps.scales import EPS
from carom.contact import Surface
from carom.io.audit import read_steps
from foreign_case import foreign_bodies, with_bodies
from grazing_discs import TIME_STEP, discs
from tampered import in_csv, in_h5, little_more

STEPS = 40
LAST = f"audit.h5:steps/{STEPS // 5 - 1:06d}"
FLOOR = carom.Plane(name="floor", point=[0.0, -1.01], normal=[0.0, 1.0])
STORED = ["output.audit=true", f"output.fields_every={5 * TIME_STEP}"]

METHODS = [
    ("gap", "theta"),
    ("gap", "conserving"),
    ("midpoint", "conserving"),
    ("endpoint", "conserving"),
    ("massless", "theta"),
    ("massless", "conserving"),
]


def collision(directory, method=("gap", "conserving"), foreign=("left",), more=()):
    """Two discs graze one another and a floor, with friction and gravity; return foreign ones."""
    condition, scheme = method
    case = discs(STEPS, condition, obstacles=[FLOOR])
    scheme = f'analysis.scheme={{kind="{scheme}"}}'
    case = case.with_overrides([*STORED, scheme, "analysis.gravity=[0.0, -9.81]", *more])
    codes = {body.name: body for body in foreign_bodies(case)}
    bodies = [codes[body.name] if body.name in foreign else body for body in case.bodies]
    result = carom.run(with_bodies(case, bodies), out=directory)
    touched = {tuple(sorted(event["pair"])) for event in result.summary["contacts"]}
    assert touched == {("floor", "left"), ("left", "right")}
    return [codes[name] for name in foreign]


@pytest.mark.parametrize("method", METHODS)
def test_a_body_that_meets_one_of_carom_is_confirmed(tmp_path, method):
    checks = confirmed(tmp_path, collision(tmp_path, method))
    assert checks["equation of motion"].count > 57 * 8
    assert checks["contact gaps"].count > 4
    assert checks["body strain"].count == 2 * 9


def test_two_of_them_are_confirmed(tmp_path):
    checks = confirmed(tmp_path, collision(tmp_path, ("midpoint", "conserving"), ("left", "right")))
    assert checks["energy of bodies"].count == 2 * 8


@pytest.fixture(scope="module")
def settled(tmp_path_factory):
    """Every step of discs of which one is damped, so that contacts settle while others land."""
    out = tmp_path_factory.mktemp("settled")
    method, every = ("midpoint", "conserving"), f"output.fields_every={TIME_STEP}"
    damped = "materials.elastic.damping={mass=0.0,stiffness=1e-3}"
    bodies = collision(out, method, more=(every, damped))
    steps = list(read_steps(out / "audit.h5"))
    assert any(step["landing"].any() and step["settling"].any() for step in steps)
    return out, bodies


def test_what_lands_on_it_while_others_settle_is_confirmed(settled):
    assert confirmed(*settled)["ledger: settling"].count == STEPS


def test_without_its_code_works_of_landing_and_settling_are_left_where_both_are(settled):
    assert 0 < confirmed(settled[0])["ledger: settling"].count < STEPS
    left = [one.what for one in carom.audit(settled[0]).unchecked]
    assert "energies of steps that depend on a body whose code is not there" in left


def thrown(directory, body, *others, method=("gap", "conserving"), **given):
    """A body on its way down to a floor, and others above it; return what is left to check."""
    dimension = body.points.shape[1]
    up = np.eye(dimension)[-1]
    condition, scheme = method
    case = carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=0.03,
            time_step=TIME_STEP,
            scheme=carom.Conserving() if scheme == "conserving" else carom.Theta(theta=0.7, xi=0.8),
            gravity=[1.0, *(-9.81 * up[1:])],
        ),
        materials={"m": carom.NeoHookean(young=3e4, poisson=0.3, density=5.0)},
        bodies=[body, *others],
        obstacles=[carom.Plane(name="floor", point=0.0 * up, normal=up)],
        contact=carom.Contact(condition=condition, friction=0.3),
        output=carom.Output(audit=True, fields_every=5e-3, history_every=TIME_STEP),
        **given,
    )
    result = carom.run(case, out=directory)
    assert len(result.summary["contacts"]) > len(others)
    return result


@pytest.mark.parametrize("method", [("gap", "conserving"), ("massless", "conserving")])
def test_a_cube_between_a_floor_and_a_block_is_confirmed(tmp_path, method):
    mesh = carom.Box(corner=[0.3, 0.2, 1.02], size=[0.6, 0.5, 0.4], divisions=[3, 3, 3])
    block = carom.Body(name="block", material="m", velocity=[0.0, 0.0, -3.0], mesh=mesh)
    cube = Lattice([0.0, 0.0, 0.01]).body("cube", velocity=[0.5, 0.2, -2.0])
    thrown(tmp_path, cube, block, method=method)
    assert confirmed(tmp_path, [cube])["contact normals"].count > 4


@pytest.mark.parametrize("scheme", ["conserving", "theta"])
def test_nothing_is_taken_for_granted_of_what_its_law_does_to_it_as_a_whole(tmp_path, scheme):
    """Springs to where it is drawn hold it, and two of its nodes are fixed in one direction.

    Symptom guarded against: free flight was asked of a body that its own law holds.
    """
    fixed = np.zeros((4, 2), dtype=bool)
    fixed[[1, 3], 0] = True
    square = Lattice([0.0, 0.01], anchor=200.0).body("square", velocity=[0.5, -2.0], fixed=fixed)
    thrown(tmp_path, square, method=("midpoint", scheme))
    checks = confirmed(tmp_path, [square])
    assert checks["supports"].count == 2 * 2 * 6
    assert "row: flight" not in checks


def test_round_off_of_energies_is_known_in_the_force_of_a_small_motion():
    """A stretched body that hardly moves: a quotient of round-off, not more than is said."""
    lattice = Lattice([0.0, 0.0])
    entry = lattice.body("square").as_entry()
    cells = (np.array([9]), np.array([[0, 2, 3, 1]]), lattice.points)
    body = ForeignBody(entry, entry.code, cells=cells, first_node=0)
    random = np.random.default_rng(1)
    start, motion = 0.1 * lattice.points, random.normal(size=(4, 2))
    noise, doubt = [], []
    for size in (1e-6, 1e-7, 1e-8):
        forces = []
        for _ in range(20):
            end = start + size * motion + 1e-16 * random.normal(size=(4, 2))
            forces.append(body.conserving_force(start, end))
            allowed = body.doubt(start, end, 100.0 * EPS * body.strain_energy(end))
        noise.append(np.linalg.norm(np.ptp(forces, axis=0), axis=1))
        doubt.append(allowed)
    assert noise[2].max() > 10.0 * noise[0].max()
    assert (np.array(noise) < doubt).all()
    # Where it moves no more than round-off there is none, nor what could be off.
    still = start + 1e-12 * motion
    assert (body.conserving_force(start, still) == body.internal_force(0.5 * (start + still))).all()
    assert not body.doubt(start, still, 1.0).any()


def test_a_mass_that_depends_on_the_direction_is_confirmed(tmp_path):
    mass = np.diag(np.tile([1.0, 2.0], 4)) + 0.05
    square = Lattice([0.0, 0.01]).body("square", velocity=[0.5, -2.0], mass=mass)
    thrown(tmp_path, square, method=("midpoint", "conserving"))
    assert confirmed(tmp_path, [square])["drifts"].figure < 1e-14
    left = [one.what for one in carom.audit(tmp_path, bodies=[square]).unchecked]
    assert any("its mass depends on the direction" in what for what in left)
    confirmed(tmp_path)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("collision")
    return out, collision(out)


@pytest.mark.parametrize(
    ("tamper", "check"),
    [
        (in_h5(f"{LAST}/end/displacement", lambda u: u + 1e-7), "equation of motion"),
        (in_h5(f"{LAST}/end/velocity", lambda v: v + 1e-7), "velocity update"),
        (in_h5(f"{LAST}/end/contact_force", lambda f: 1.001 * f), "equation of motion"),
        (in_h5(f"{LAST}/ledger@strain", little_more), "ledger: strain"),
        (in_h5("fields.vtkhdf:VTKHDF/PointData/velocity", little_more), "kinetic energy"),
        (in_csv("history.csv", "left.strain", row=-1), "body strain"),
        (in_csv("history.csv", "left.vibration", row=-1), "kinetic parts"),
        (in_csv("history.csv", "left.v_x", row=-1), "drifts"),
        (in_csv("ledger.csv", "strain", row=-4), "books: energies"),
    ],
)
def test_a_changed_number_is_found(run, tmp_path, tamper, check):
    out, bodies = run
    assert check in refuted_after(out, tmp_path, tamper, bodies)


@pytest.mark.parametrize(
    ("change", "checks"),
    [
        ("young=2703.0", {"equation of motion", "strain energy", "ledger: strain"}),
        ("density=1.001", {"equation of motion", "kinetic energy", "momentum", "books: external"}),
    ],
)
def test_another_law_is_found(run, change, checks):
    out, _ = run
    case = discs(STEPS).with_overrides([f"materials.elastic.{change}"])
    audit = carom.audit(out, bodies=foreign_bodies(case)[:1])
    assert checks <= {check.name for check in audit.refuted}


def test_what_its_code_says_of_its_start_and_its_mesh_is_compared(run):
    out, (body,) = run
    faster, moved, open_sided = copy(body), copy(body), copy(body)
    faster.velocity = body.velocity + 1e-6
    moved.points = body.points + 1e-6
    fewer = Surface("left", body.surface.facets[0][1:])
    open_sided.surface = fewer
    found = [
        {check.name for check in carom.audit(out, bodies=[one]).refuted}
        for one in (faster, moved, open_sided)
    ]
    assert found[0] == {"initial velocity"}
    assert "mesh" in found[1]
    assert "surface: facets" in found[2]


def test_without_its_code_all_else_is_confirmed_and_the_rest_is_said_to_be_unchecked(run):
    out, _ = run
    audit = carom.audit(out)
    assert audit.confirmed
    checks = {check.name: check for check in audit.checks}
    assert checks["Coulomb: cone"].count > 4
    # Of the other body alone.
    assert checks["equation of motion"].where.startswith("right")
    assert checks["equation of motion"].count == 57 * 8
    assert checks["books: energies"].count == 2 * 9
    assert not {"kinetic energy", "momentum", "energy of the step", "row: kinetic"} & checks.keys()
    (unchecked,) = (one for one in audit.unchecked if "'left'" in one.what)
    assert "give its carom.ForeignBody to carom.audit(…, bodies=[…])" in str(unchecked)
    believed = {"history.csv: left.spin", "history.csv: momentum_x", "summary.json: dofs"}
    assert believed <= set(unchecked.numbers)


@pytest.mark.parametrize("method", [METHODS[2], METHODS[4], METHODS[5]])
def test_without_its_code_every_condition_is_confirmed(tmp_path, method):
    collision(tmp_path, method)
    assert confirmed(tmp_path)["Signorini: complementarity"].count > 4


def test_without_any_code_contacts_are_checked_alone(tmp_path):
    square = Lattice([0.0, 0.01]).body("square", velocity=[0.5, -2.0])
    thrown(tmp_path, square, method=("midpoint", "conserving"))
    checks = confirmed(tmp_path)
    assert checks["contact gaps"].count > 1
    assert "equation of motion" not in checks


@pytest.mark.parametrize(
    ("tamper", "check"),
    [
        (in_h5(f"{LAST}/end/contact_reaction", lambda r: 1.001 * r), "nodal reactions"),
        (in_h5(f"{LAST}/end/contact_gap", little_more), "contact gaps"),
        (in_h5(f"{LAST}/end/displacement", little_more), "stored steps"),
        (in_h5(f"{LAST}/start/velocity", lambda v: v + 1e-6), "velocity update"),
        (in_h5(f"{LAST}/ledger@friction", little_more), "ledger: friction"),
        (in_csv("history.csv", "left.strain", row=-1), "row: parts"),
        (in_csv("history.csv", "right.strain", row=-1), "body strain"),
        (in_csv("history.csv", "normal_force", row=-1), "normal force"),
    ],
)
def test_without_its_code_a_changed_number_is_found(run, tmp_path, tamper, check):
    assert check in refuted_after(run[0], tmp_path, tamper)


def test_the_command_says_what_it_could_not_check(run):
    done = CliRunner().invoke(cli.app, ["audit", str(run[0])])
    assert done.exit_code == 0
    said = " ".join(done.output.split())
    assert "not checked" in said
    assert "carom.ForeignBody" in said
    assert "cannot be checked from what is stored" in said


@pytest.mark.parametrize(
    ("body", "message"),
    [
        (
            Lattice([0.0, 0.0]).body("right"),
            "bodies: 'right' is of no other code here; known: left",
        ),
        (Lattice([0.0, 0.0]).body("left"), "bodies: 'left' has points of shape [4, 2], and of"),
        ("left", "bodies: a str is no body of another code; give carom.ForeignBody"),
    ],
)
def test_what_is_no_body_of_the_run_is_refused(run, body, message):
    with pytest.raises(carom.InputError, match=re.escape(message)):
        carom.audit(run[0], bodies=[body])
