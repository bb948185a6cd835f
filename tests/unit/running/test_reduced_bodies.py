"""Reduced bodies from case to results: restart, fields, doctor, audit, what is refused."""

import numpy as np
import pytest
import tomlkit

import carom
import restarting
from carom.doctor import examine

STEEL = {"steel": carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)}
BAR = carom.Rectangle(corner=[0.0, 0.0], size=[2.0, 0.5], divisions=[16, 4])


def bar(**given):
    """Return a bar that may touch with its left end and turns."""
    base = {
        **{"name": "bar", "material": "steel", "mesh": BAR, "modes": 6, "contact_sets": ["left"]},
        **{"velocity": [-0.2, 0.0], "spin": 0.3},
    }
    return carom.ReducedBody(**{**base, **given})


def case(body=None, **given):
    """Return the case of a bar that flies at a wall."""
    base = {
        "analysis": carom.Dynamic(end_time=0.2, time_step=2e-3),
        "materials": STEEL,
        "bodies": [body or bar()],
        "obstacles": [carom.Plane(name="wall", point=[-0.01, 0.0], normal=[1.0, 0.0])],
        "contact": carom.Contact(condition="midpoint", friction=0.3),
        "output": carom.Output(
            fields_every=0.05,
            history_every=0.01,
            track=[carom.Track(name="tip", body="bar", point=[2.0, 0.5])],
        ),
    }
    return carom.Scenario(**{**base, **given})


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return carom.run(case(), out=tmp_path_factory.mktemp("reduced") / "whole")


def test_the_case_file_knows_reduced_bodies():
    written = case().to_toml()
    assert 'kind = "reduced"' in written and "modes = 6" in written
    assert carom.Scenario.from_dict(tomlkit.parse(written).unwrap()) == case()


def test_an_impact_keeps_energy_and_momentum(run):
    history = run.history
    kept = history["total"] + history["friction"]
    assert np.abs(kept - kept[0]).max() < 1e-10 * kept[0]
    assert history["friction"][-1] > 1e-4 * kept[0]
    assert history["strain"].max() > 1e-2 * kept[0]


def test_all_nodes_are_parts_of_one_body(run):
    """The outer ones move in every step, those inside where somebody looks."""
    points = run.fields.points
    near = np.linalg.norm(points[:, None] - points, axis=2)
    one, other = np.nonzero((near > 0) & (near < 0.18))
    for displacement in run.fields["displacement"][1:]:
        moved = points + np.asarray(displacement)[:, :2]
        stretch = np.linalg.norm(moved[one] - moved[other], axis=1) / near[one, other]
        assert 1e-3 < np.abs(stretch - 1.0).max() < 0.05
    tip = np.argmin(np.linalg.norm(points - [2.0, 0.5], axis=1))
    told = [run.history[f"tip.u_{axis}"][-1] for axis in "xy"]
    assert np.asarray(displacement)[tip, :2] == pytest.approx(told)


def test_the_audit_confirms_energies_momenta_and_stresses(run):
    audit = carom.audit(run.path)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["strain energy"].count > 2
    assert checks["angular momentum"].count > 2


def test_the_doctor_says_what_spin_leaves_out():
    findings = [f for f in examine(case()).findings if "is reduced to" in f.what]
    assert [f.level for f in findings] == ["ok"]
    fast = examine(case(bar(spin=8.0), obstacles=[]))
    (finding,) = [f for f in fast.findings if "leaves out how spin stretches it" in f.what]
    assert finding.level == "warning"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"modes": 1000}, "displacements inside, and no more modes"),
        ({"mesh": BAR.model_copy(update={"periodic": True})}, "a reduced body cannot be periodic"),
        ({"contact_sets": ["inner"]}, "no such set of facets"),
    ],
)
def test_bodies_that_cannot_be_reduced_are_refused(given, message):
    with pytest.raises(carom.InputError, match=message):
        carom.check(case(bar(**given)))


def fixed(**given):
    return [carom.Fixed(body="bar", on="right", **given)]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"motions": fixed()}, "is reduced and free: only gravity and contacts act on it"),
        (
            {"loads": [carom.Force(body="bar", on="right", force=[1.0, 0.0])]},
            "is reduced and free: only gravity and contacts act on it",
        ),
        (
            {
                "analysis": carom.Static(end_time=1.0, time_step=1.0),
                "bodies": [bar(velocity=None, spin=None)],
                "obstacles": [],
                "output": carom.Output(),
                "contact": carom.Contact(condition="gap"),
            },
            "is reduced and moves in time alone",
        ),
        (
            {
                "materials": {
                    "steel": STEEL["steel"].model_copy(
                        update={"viscosity": carom.Viscosity(shear=1.0)}
                    )
                }
            },
            "is reduced; damp it by damping.stiffness instead",
        ),
        (
            {
                "materials": {
                    "steel": STEEL["steel"].model_copy(update={"damping": carom.Damping(mass=1.0)})
                }
            },
            "damping of mass would brake its flight",
        ),
        (
            {
                "materials": {
                    "steel": carom.J2Plasticity(
                        young=2700.0, poisson=0.33, density=1.0, yield_stress=10.0
                    )
                }
            },
            "is reduced and cannot flow",
        ),
    ],
)
def test_cases_that_drive_reduced_bodies_are_refused(given, message):
    with pytest.raises(carom.InputError, match=message):
        carom.check(case(**given))


def test_a_reduced_body_starts_as_it_is_drawn():
    given = carom.Initial(displacements=[carom.InitialDisplacement(body="bar", result="before")])
    with pytest.raises(carom.InputError, match="starts as drawn; leave it out"):
        case(initial=given)


def slender(modes, **given):
    """Return a bar of this many modes, or with its whole mesh."""
    mesh = carom.Rectangle(corner=[0.0, 0.0], size=[4.0, 0.5], divisions=[32, 4])
    given = {"name": "bar", "material": "steel", "mesh": mesh, "contact_sets": ["left"], **given}
    return carom.Body(**given) if modes is None else carom.ReducedBody(modes=modes, **given)


def test_the_more_modes_the_more_an_impact_is_that_of_the_whole_linear_body():
    linear = carom.LinearElastic(young=2700.0, poisson=0.33, density=1.0)

    def end(modes):
        simulation = carom.Simulation(
            case(
                slender(modes, velocity=[-0.2, 0.0]),
                materials={"steel": linear},
                analysis=carom.Dynamic(end_time=0.3, time_step=1e-3),
                obstacles=[carom.Plane(name="wall", point=[0.0, 0.0], normal=[1.0, 0.0])],
                contact=carom.Contact(condition="gap", friction=0.3),
                output=carom.Output(
                    history_every=1e-3,
                    track=[carom.Track(name="end", body="bar", point=[4.0, 0.25])],
                ),
            )
        )
        simulation.advance(0.3)
        history = simulation.history
        assert np.abs(history["defect"]).max() < 1e-10 * history["total"][0]
        return history["end.u_x"]

    # With `gap`: what is given back on landing hangs on how bodies tell their masses.
    whole = end(None)
    inside = 2 * (33 * 5 - 5)
    errors = [
        np.abs(end(modes) - whole).max() / np.abs(whole).max()
        for modes in (0, 4, 8, 16, 64, inside)
    ]
    assert (np.diff(errors) < 0.0).all(), errors
    assert errors[3] < 0.05, errors
    assert errors[5] < 1e-11, errors


def test_a_reduced_body_and_a_whole_one_keep_momentum_and_energy():
    disc = carom.Body(
        name="soft",
        material="steel",
        mesh=carom.Disc(centre=[-1.05, 0.3], radius=1.0, divisions=4),
        velocity=[0.5, 0.0],
    )
    simulation = carom.Simulation(
        case(
            bodies=[slender(6, velocity=[-1.0, 0.0], spin=0.4), disc],
            obstacles=[],
            analysis=carom.Dynamic(end_time=0.4, time_step=2e-3),
            output=carom.Output(),
        )
    )
    simulation.advance(0.4)
    history = simulation.history
    energy = history["total"][0]
    kept = history["total"] + history["friction"]
    assert np.abs(kept - kept[0]).max() < 1e-10 * energy
    for name in ("momentum_x", "momentum_y"):
        assert np.abs(history[name] - history[name][0]).max() < 1e-11 * energy
    # Reactions act where nodes land half way, on two sides of what is open: of whole bodies, too.
    moment = history["angular_momentum"]
    assert np.abs(moment - moment[0]).max() < 1e-4 * energy
    assert history["friction"][-1] > 1e-3 * energy
    assert history["strain"][-1] > 1e-2 * energy


def test_books_close_to_round_off_whatever_the_step():
    """Symptom guarded against: 2e-9 of the energy, as round-off of places was one of velocities."""
    mesh = carom.Box(corner=[0.0] * 3, size=[1.0, 0.05, 0.05], divisions=[20, 2, 2])
    steel = carom.LinearElastic(young=210e9, poisson=0.3, density=7800.0)
    bar = {"name": "bar", "material": "steel", "mesh": mesh, "modes": 20, "contact_sets": ["left"]}
    bar |= {"velocity": [-1.0, 0.0, 0.0], "spin": [0.0, 0.5, 1.0]}
    for step in (2e-6, 2e-7):
        simulation = carom.Simulation(
            carom.Scenario(
                dimension=3,
                analysis=carom.Dynamic(end_time=100 * step, time_step=step),
                materials={"steel": steel},
                bodies=[carom.ReducedBody(**bar)],
                obstacles=[carom.Plane(name="wall", point=[0.0] * 3, normal=[1.0, 0.0, 0.0])],
                contact=carom.Contact(condition="midpoint", friction=0.2),
                output=carom.Output(history_every=step, fields_every=100 * step),
            )
        )
        simulation.advance(100 * step)
        history = simulation.history
        assert history["friction"][-1] > 1e-3 * history["total"][0]
        # Measured: 2e-11 in 400 steps.
        assert np.abs(history["defect"]).max() < 1e-10 * history["total"][0], step


@pytest.mark.filterwarnings("ignore:.*inside one another")
def test_what_may_not_touch_is_found_inside_and_is_no_contact(tmp_path):
    """Symptom guarded against: the core panicked at a node beyond the surface that is kept."""
    below = carom.Body(
        name="below",
        material="steel",
        mesh=carom.Rectangle(corner=[0.4, -0.55], size=[1.0, 0.5], divisions=[8, 4]),
    )
    flat = bar(velocity=[0.0, -1.0], spin=None)
    floor = carom.Plane(name="floor", point=[0.0, -0.05], normal=[0.0, 1.0])
    for k, others in enumerate(
        ({"bodies": [flat, below], "obstacles": []}, {"bodies": [flat], "obstacles": [floor]})
    ):
        with pytest.raises(carom.PenetrationError, match="inside one another"):
            carom.run(case(**others), out=tmp_path / f"run-{k}")


def test_looking_at_a_run_changes_nothing():
    """Nodes that no step asks for are placed where somebody looks."""
    left_alone, looked_at = carom.Simulation(case()), carom.Simulation(case())
    left_alone.advance(0.2)
    while looked_at.time < 0.2:
        looked_at.step()
        assert np.isfinite(looked_at.bodies["bar"].displacement).all()
    for column, values in left_alone.history.items():
        assert np.array_equal(values, looked_at.history[column]), column
    for what in ("displacement", "velocity"):
        one, other = (getattr(run.bodies["bar"], what) for run in (left_alone, looked_at))
        assert np.array_equal(one, other), what


def test_a_tracked_node_inside_moves_where_all_of_the_outline_may_touch():
    """There is then no node of the outline left to place."""
    whole = bar(contact_sets=None, velocity=[-0.2, 0.0])
    track = [carom.Track(name="inner", body="bar", point=[1.0, 0.25])]
    simulation = carom.Simulation(
        case(whole, output=carom.Output(history_every=0.01, fields_every=0.2, track=track))
    )
    simulation.advance(0.04)
    history = simulation.history
    body = simulation.bodies["bar"]
    node = np.argmin(np.linalg.norm(body.points - [1.0, 0.25], axis=1))
    assert history["inner.u_x"][-1] == pytest.approx(body.displacement[node, 0], rel=1e-12)
    assert history["inner.v_x"][-1] == pytest.approx(body.velocity[node, 0], rel=1e-12)
    assert history["inner.u_x"][-1] == pytest.approx(-0.2 * 0.04, rel=0.2)


@pytest.mark.parametrize("cell", ["hex8", "hex20", "tet10"])
def test_reduced_blocks_of_every_order_keep_their_energy_with_gravity_and_friction(cell):
    mesh = carom.Box(corner=[0.0, 0.0, 0.02], size=[1.0, 0.2, 0.2], divisions=[6, 2, 2], cell=cell)
    block = {"name": "block", "material": "steel", "mesh": mesh, "modes": 8}
    block |= {"contact_sets": ["bottom"], "velocity": [0.3, 0.0, -1.0], "spin": [0.1, 0.3, 0.0]}
    simulation = carom.Simulation(
        tumbling(
            bodies=[carom.ReducedBody(**block)],
            analysis=carom.Dynamic(end_time=0.1, time_step=1e-3, gravity=[0.0, 0.0, -9.81]),
            output=carom.Output(),
        )
    )
    simulation.advance(0.1)
    history = simulation.history
    kept = history["total"].max()
    assert np.abs(history["defect"]).max() < 1e-10 * kept
    assert history["friction"][-1] > 1e-2 * kept


def test_damping_of_the_stiffness_takes_vibrations_and_leaves_the_flight():
    damped = STEEL["steel"].model_copy(update={"damping": carom.Damping(stiffness=1e-3)})
    simulation = carom.Simulation(case(materials={"steel": damped}))
    simulation.advance(0.2)
    history = simulation.history
    kept = history["total"]
    assert np.abs(history["defect"]).max() < 1e-10 * kept[0]
    assert history["viscous"][-1] > 1e-4 * kept[0]


BLOCK = carom.Box(corner=[0.0, 0.0, 0.05], size=[0.4, 0.1, 0.1], divisions=[8, 2, 2])


def tumbling(**given):
    """Return the case of a block in space that turns about no axis of its own."""
    block = {
        **{"name": "block", "material": "steel", "mesh": BLOCK, "modes": 4},
        **{"contact_sets": ["bottom"], "velocity": [0.2, 0.0, -0.5], "spin": [0.5, 1.0, 0.3]},
    }
    base = {
        "dimension": 3,
        "analysis": carom.Dynamic(end_time=0.2, time_step=2e-3, gravity=[0.0, 0.0, -1.0]),
        "materials": STEEL,
        "bodies": [carom.ReducedBody(**block)],
        "obstacles": [carom.Plane(name="floor", point=[0.0] * 3, normal=[0.0, 0.0, 1.0])],
        "contact": carom.Contact(condition="midpoint", friction=0.3),
        "output": carom.Output(history_every=4e-3, fields_every=5e-2, checkpoint_every=2e-2),
    }
    return carom.Scenario(**{**base, **given})


def test_a_block_in_space_keeps_energy_and_momenta_as_it_flies():
    simulation = carom.Simulation(
        tumbling(
            analysis=carom.Dynamic(end_time=20.0, time_step=1e-2),
            obstacles=[],
            output=carom.Output(history_every=0.5, fields_every=10.0),
        )
    )
    simulation.advance(20.0)
    history = simulation.history
    for name in ("total", "angular_momentum_x", "angular_momentum_y", "angular_momentum_z"):
        drift = np.abs(history[name] - history[name][0]).max()
        assert drift < 1e-11 * history["total"][0], name
    # It does turn about other axes than it set out with.
    assert np.ptp(history["block.spin_y"]) > 0.1
    assert history["strain"].max() < 1e-20 * history["total"][0]


def test_a_stopped_run_of_a_reduced_body_goes_on_to_the_last_bit(tmp_path):
    whole = carom.run(tumbling(), out=tmp_path / "whole")
    assert whole.summary["contacts"]
    assert whole.history["strain"].max() > 1e-3 * whole.history["total"][0]

    def stop(state):
        if state.time > 0.11:
            raise carom.Stop

    watched = [carom.Observer(stop, every=0.01)]
    stopped = carom.run(tumbling(), out=tmp_path / "parts", observers=watched)
    assert stopped.summary["status"] != "completed"
    end = carom.run(tumbling(), out=tmp_path / "parts", resume=True)
    assert end.summary["status"] == "completed"
    restarting.assert_same_results(tmp_path / "parts", whole.path)
