"""Several analyses in one case: what goes on from one to the next, and what they leave."""

import itertools

import numpy as np
import pytest

import carom
import restarting
import staging
from carom.io import layout

BODIES = ("base", "lid")


@pytest.fixture(scope="module")
def joint(tmp_path_factory):
    """The results of a joint that is pressed, hit and comes to rest; not to be changed."""
    return carom.run(staging.scenario(), out=tmp_path_factory.mktemp("joint"))


def largest(simulation, what):
    return max(np.abs(getattr(simulation.bodies[name], what)).max() for name in BODIES)


def test_the_books_of_every_stage_and_of_the_whole_are_closed(joint):
    stages, whole = joint.summary["stages"], joint.summary["energy"]
    assert [stage["name"] for stage in stages] == ["preload", "hit", "rest"]
    assert [stage["steps"] for stage in stages] == [2, 80, 1]
    largest_energy = max(joint.history["total"] + joint.history["friction"])
    for stage in (*stages, {"energy": whole}):
        assert stage["energy"]["max_defect"] < 1e-11 * largest_energy
    for before, after in itertools.pairwise(stages):
        assert after["energy"]["initial"] == before["energy"]["final"]
        assert after["start_time"] == before["end_time"]
    for term in ("external", "prescribed", "friction", "scheme", "normal_contact", "settling"):
        together = sum(stage["energy"][term] for stage in stages)
        assert together == pytest.approx(whole[term], abs=1e-12 * largest_energy)
    for part, total in (("bodies", joint.summary["bodies"]), ("pairs", joint.summary["pairs"])):
        for index, books in enumerate(total):
            together = sum(stage[part][index]["prescribed"] for stage in stages)
            assert together == pytest.approx(books["prescribed"], abs=1e-12 * largest_energy)
    # What moved when the static stage began is what the scheme took.
    hit, rest = stages[1]["energy"], stages[2]["energy"]
    assert hit["kinetic"] > 0.1 * hit["final"]
    assert rest["kinetic"] == 0.0


def test_the_history_says_which_stage_a_row_is_of(joint):
    time, stage = joint.history["time"], joint.history["stage"]
    assert set(stage) == {1.0, 2.0, 3.0}
    ends = [time[stage == number][-1] for number in (1, 2, 3)]
    assert ends == [1.0, 1.00004, 2.00004]
    np.testing.assert_allclose(joint.fields.times[[0, -1]], [0.0, 2.00004])
    assert {1.0, 1.00004} <= set(joint.fields.times)
    # As often in the hit, of 40 µs, as the hit itself asks for.
    assert np.count_nonzero(stage == 2) == 80


STILL = {"massless": (5e-5, 2e-5, 1e-11, 2e-9)}
"""How fast, and how far off in reactions, displacements and friction, a joint at rest may be."""


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint", "massless", "mortar"])
def test_a_joint_at_rest_stays_at_rest_when_it_becomes_dynamic(condition):
    """Symptom guarded against: a jump of reactions between stages that sets off waves.

    What the load steps leave of balance, 2e-11 J of 0.4 J, massless contact gives to vibration.
    Measured there: 1.1e-5 m/s, 4.4e-6 of the reactions, 2.6e-12 m, 3e-10 J; elsewhere 1e-10 m/s.
    """
    fast, off, far, rubbed = STILL.get(condition, (5e-8, 1e-8, 1e-15, 1e-10))
    key = "discretisation" if condition == "mortar" else "condition"
    overrides = ["stages.1.loads=[]", f"contact.{key}={condition}"]
    overrides += ["bodies.0.mesh.divisions=[14, 4]", "bodies.1.mesh.divisions=[11, 4]"]
    simulation = carom.Simulation(staging.scenario(*overrides))
    simulation.advance(1.0)
    assert simulation.stage == "preload"
    bodies = [simulation.bodies[name] for name in BODIES]
    pressed = [body.displacement for body in bodies]
    reactions = [body.reaction for body in bodies]
    friction = simulation.ledger.friction
    while simulation.time < 1.00004 - 1e-8:
        simulation.step()
        # The preload itself, 0.7 µm within a wave's 7 µs, is 0.1 m/s.
        assert largest(simulation, "velocity") < fast
        for body, before in zip(bodies, reactions, strict=True):
            np.testing.assert_allclose(body.reaction, before, atol=off * np.abs(before).max())
    assert simulation.stage == "hit"
    for body, before in zip(bodies, pressed, strict=True):
        np.testing.assert_allclose(body.displacement, before, atol=far)
    assert simulation.ledger.friction == pytest.approx(friction, abs=rubbed)


@pytest.mark.parametrize("cell", ["quad4", "tri3", "quad8"])
@pytest.mark.parametrize("slope", [0.0, 0.5])
def test_what_gravity_has_pressed_down_goes_on_resting(cell, slope):
    """Symptom guarded against: without mass on its sides a block weighed in other places.

    The step of the second stage failed, or the block slid down a slope that holds it, by 1 mm.
    """
    mesh = carom.Rectangle(corner=(0, 0), size=(1.0, 0.3), divisions=(8, 4), cell=cell)
    gravity = (9.81 * np.sin(slope), -9.81 * np.cos(slope))
    scenario = carom.Scenario(
        stages=[
            carom.Stage(
                name="rest", analysis=carom.Static(end_time=1.0, time_step=0.25, gravity=gravity)
            ),
            carom.Stage(name="on", analysis=carom.Dynamic(end_time=1.1, time_step=1e-3)),
        ],
        materials={"m": carom.SaintVenantKirchhoff(young=1e7, poisson=0.3, density=1000.0)},
        bodies=[carom.Body(name="block", material="m", mesh=mesh)],
        obstacles=[carom.Plane(name="floor", point=(0, 0), normal=(0, 1))],
        contact=carom.Contact(friction=0.6),
    )
    simulation = carom.Simulation(scenario)
    simulation.advance(1.0)
    pressed, strain = simulation.bodies["block"].displacement, simulation.energy.strain
    iterations = 0
    while not simulation.has_ended:
        iterations += simulation.step().iterations
    far = np.abs(simulation.bodies["block"].displacement - pressed).max()
    # Measured: 1e-9 m of 5e-5 m, and what load steps leave of balance, 1.4e-9 of the energy.
    assert far < 1e-8
    assert simulation.energy.kinetic < 1e-8 * strain
    assert np.abs(simulation.history["defect"]).max() < 1e-8 * strain
    # Measured: 2.4 per step, where a blend of nothing took 12.
    assert iterations < 400


def test_what_another_run_has_pressed_down_goes_on_resting(tmp_path):
    """Symptom guarded against: with massless contact a block slid down a slope that holds it."""
    gravity = (9.81 * np.sin(0.5), -9.81 * np.cos(0.5))
    case = {
        "materials": {"m": carom.SaintVenantKirchhoff(young=1e7, poisson=0.3, density=1000.0)},
        "bodies": [
            carom.Body(
                name="block",
                material="m",
                mesh=carom.Rectangle(corner=(0, 0), size=(1.0, 0.3), divisions=(8, 4)),
            )
        ],
        "obstacles": [carom.Plane(name="floor", point=(0, 0), normal=(0, 1))],
        "contact": carom.Contact(friction=0.6),
    }
    pressed = carom.Static(end_time=1.0, time_step=0.25, gravity=gravity)
    carom.run(carom.Scenario(analysis=pressed, **case), out=tmp_path / "pressed")
    goes_on = carom.Dynamic(end_time=1.1, time_step=1e-3, gravity=gravity)
    start = carom.Initial(result=str(tmp_path / "pressed"), time=1.0)
    run = carom.run(
        carom.Scenario(analysis=goes_on, initial=start, **case), out=tmp_path / "goes on"
    )
    assert np.ptp(run.history["block.x"]) < 1e-14
    assert run.history["kinetic"].max() < 1e-20
    # Without mass on its sides it weighs elsewhere: it gives way a little, and the books close.
    case["contact"] = carom.Contact(friction=0.6, condition="massless")
    elsewhere = carom.Scenario(analysis=goes_on, initial=start, **case)
    moved = carom.run(elsewhere, out=tmp_path / "elsewhere")
    assert np.ptp(moved.history["block.x"]) < 1e-3
    assert abs(moved.history["defect"][-1]) < 1e-13 * moved.summary["energy"]["external"]


def test_nothing_happens_at_the_border_of_stages():
    """The first step of the hit starts from the very state that the preload ended in."""
    simulation = carom.Simulation(staging.scenario())
    simulation.advance(1.0)
    energy, ledger = simulation.energy, simulation.ledger
    reaction = simulation.contacts.force("lid")
    simulation.step()
    assert simulation.stage == "hit"
    # 0.5 µs of a load that starts from none.
    assert simulation.energy.strain == pytest.approx(energy.strain, rel=1e-4)
    assert simulation.ledger.friction == pytest.approx(ledger.friction, rel=1e-6)
    np.testing.assert_allclose(
        simulation.contacts.force("lid"), reaction, atol=1e-2 * np.linalg.norm(reaction)
    )


@pytest.mark.parametrize("stop_at", [0.5, 1.0, 1.00001, 1.00004])
def test_a_run_that_stops_in_any_stage_goes_on_to_the_last_bit(joint, tmp_path, stop_at):
    def stop(state):
        if state.time >= stop_at - 1e-9:
            raise carom.Stop

    carom.run(staging.scenario(), out=tmp_path, observers=[carom.Observer(stop)])
    assert (tmp_path / layout.CHECKPOINT).exists()
    assert not (tmp_path / layout.END_STATE).exists()
    resumed = carom.run(staging.scenario(), out=tmp_path, resume=True)
    assert resumed.summary["status"] == "completed"
    restarting.assert_same_results(tmp_path, joint.path)


def test_observers_by_steps_and_by_time_see_every_stage(tmp_path):
    by_steps, by_time = [], []
    carom.run(
        staging.scenario(),
        out=tmp_path,
        observers=[
            carom.Observer(lambda state: by_steps.append((state.steps, state.stage)), steps=20),
            carom.Observer(lambda state: by_time.append(state.time), every=1e-5),
        ],
    )
    assert [steps for steps, _ in by_steps] == [0, 20, 40, 60, 80, 83]
    assert [stage for _, stage in by_steps] == ["preload", "hit", "hit", "hit", "hit", "rest"]
    np.testing.assert_allclose(
        by_time, [0.0, 0.5, 1.0, 1.00001, 1.00002, 1.00003, 1.00004, 2.00004], rtol=1e-12
    )


def test_python_objects_are_the_case_file(joint):
    steel = carom.LinearElastic(young=210e9, poisson=0.3, density=7800.0)
    lid = carom.Rectangle(corner=(0.02, 0.02), size=(0.06, 0.02), divisions=(7, 2))
    base = carom.Rectangle(corner=(0.0, 0.0), size=(0.10, 0.02), divisions=(10, 2))
    pressure = carom.Pressure(body="lid", on="top", pressure="1e7*min(t, 1)")
    blow = "3e7*sin(pi*(t - 1)/2e-5)*step(1.00002 - t)"
    scenario = carom.Scenario(
        title="Joint",
        materials={"steel": steel},
        bodies=[
            carom.Body(name="base", material="steel", mesh=base),
            carom.Body(name="lid", material="steel", mesh=lid),
        ],
        motions=[carom.Fixed(body="base", on="bottom")],
        contact=carom.Contact(friction=0.3),
        stages=[
            carom.Stage(
                name="preload",
                analysis=carom.Static(end_time=1.0, time_step=0.5),
                loads=[pressure],
            ),
            carom.Stage(
                name="hit",
                analysis=carom.Dynamic(end_time=1.00004, time_step=5e-7),
                loads=[carom.Traction(body="lid", on="left", traction=(blow, 0.0))],
            ),
            carom.Stage(name="rest", analysis=carom.Static(end_time=2.00004, time_step=1.0)),
        ],
    )
    assert scenario.to_json() == joint.scenario.to_json() == staging.scenario().to_json()


def spring(*stages, **more):
    """A block on a held side, with whatever is done to it."""
    return carom.Scenario.from_dict(
        {
            "materials": staging.CASE["materials"],
            "bodies": [
                {
                    "name": "block",
                    "material": "steel",
                    "mesh": {
                        "kind": "rectangle",
                        "corner": [0, 0],
                        "size": [0.02, 0.01],
                        "divisions": [4, 2],
                    },
                    **more.pop("body", {}),
                }
            ],
            "motions": [{"kind": "fixed", "body": "block", "on": "left"}],
            "stages": list(stages),
            **more,
        }
    )


def static(name, end, **more):
    return {
        "name": name,
        "analysis": {"kind": "static", "end_time": end, "time_step": 0.5},
        **more,
    }


PULL = {"kind": "traction", "body": "block", "on": "right", "traction": [1e8, 0.0]}


def tip(scenario):
    """Where the right side is at the end of every stage [m]."""
    simulation = carom.Simulation(scenario)
    block, found = simulation.bodies["block"], []
    right = np.isclose(block.points[:, 0], 0.02)
    for stage in scenario.full_stages():
        simulation.advance(stage.end_time)
        found.append(block.displacement[right].mean(axis=0)[0])
    return np.array(found)


def test_loads_go_on_until_they_are_replaced_or_removed():
    removed = [{"kind": "traction", "body": "block", "on": "right"}]
    half = {**PULL, "traction": [0.5e8, 0.0]}
    u = tip(
        spring(
            static("pull", 1.0, loads=[PULL]),
            static("on", 2.0),
            static("half", 3.0, loads=[half]),
            static("none", 4.0, removed_loads=removed),
        )
    )
    assert u[0] > 1e-6
    np.testing.assert_allclose(u, u[0] * np.array([1.0, 1.0, 0.5, 0.0]), atol=1e-9 * u[0])


def test_what_is_fixed_later_stays_where_it_is():
    """Symptom guarded against: a support that snaps back to where the body was drawn."""
    removed = [{"kind": "traction", "body": "block", "on": "right"}]
    u = tip(
        spring(
            static("pull", 1.0, loads=[PULL]),
            static(
                "hold",
                2.0,
                removed_loads=removed,
                motions=[{"kind": "fixed", "body": "block", "on": "right", "components": ["x"]}],
            ),
            static("free", 3.0, removed_motions=[{"body": "block", "on": "right"}]),
        )
    )
    # A side that is held straight is where its mean was.
    assert u[1] == pytest.approx(u[0], rel=1e-12)
    assert abs(u[2]) < 1e-9 * u[0]


def test_prescribed_displacements_count_from_the_stage_that_names_them():
    def led(x):
        return [{"kind": "prescribed", "body": "block", "on": "right", "x": x}]

    u = tip(
        spring(
            static("first", 1.0, motions=led("1e-6*t")),
            static("on", 2.0),
            static("back", 3.0, motions=led("-5e-7*(t - 2)")),
        )
    )
    np.testing.assert_allclose(u, [1e-6, 2e-6, 1.5e-6], rtol=1e-12)


def test_gravity_goes_on_until_a_stage_says_otherwise():
    def falls(gravity):
        return {} if gravity is None else {"gravity": gravity}

    stages = []
    for end, gravity in ((1.0, [1000.0, 0.0]), (2.0, None), (3.0, [0.0, 0.0])):
        stage = static(f"until-{end:g}", end)
        stage["analysis"] |= falls(gravity)
        stages.append(stage)
    stages = [{**stage, "name": stage["name"].replace(".", "-")} for stage in stages]
    u = tip(spring(*stages))
    assert u[0] > 1e-10
    np.testing.assert_allclose(u, u[0] * np.array([1.0, 1.0, 0.0]), atol=1e-9 * u[0])


def test_friction_of_a_stage_holds_from_there_on(tmp_path):
    """A lid under gravity that is pushed: it sticks until a stage takes its friction."""
    case = staging.case()
    stages = case["stages"]
    stages[1] = {
        "name": "push",
        "analysis": {"kind": "static", "end_time": 2.0, "time_step": 0.5},
        "loads": [
            {"kind": "traction", "body": "lid", "on": "left", "traction": ["4e6*(t - 1)", 0]}
        ],
    }
    stages[2] = {
        "name": "oiled",
        "analysis": {"end_time": 2.0001, "time_step": 1e-6},
        "contact": {"pairs": [{"between": ["lid", "base"], "friction": 0.01}]},
    }
    simulation = carom.Simulation(carom.Scenario.from_dict(case))
    simulation.advance(2.0)
    stuck = simulation.bodies["lid"].displacement[:, 0].mean()
    simulation.advance(2.0001)
    slid = simulation.bodies["lid"].displacement[:, 0].mean()
    assert 0.0 < stuck < 1e-6
    # 4e6 Pa · 0.02 m less friction on 9.36 kg for 0.1 ms: ½·a·t² = 43 µm less what friction takes.
    assert slid == pytest.approx(0.5 * (4e6 * 0.02 - 0.01 * 6e5) / 9.36 * 1e-8, rel=0.05)


def test_a_velocity_that_a_stage_gives_is_work_in_its_books():
    case = staging.case()
    case["bodies"].append(
        {
            "name": "hammer",
            "material": "steel",
            "mesh": {
                "kind": "rectangle",
                "corner": [-0.02, 0.022],
                "size": [0.01, 0.01],
                "divisions": [2, 2],
            },
        }
    )
    case["motions"].append({"kind": "fixed", "body": "hammer", "on": "all"})
    case["stages"][1] = {
        "name": "hit",
        "analysis": {"end_time": 1.00002, "time_step": 5e-7},
        "removed_motions": [{"body": "hammer", "on": "all"}],
        "velocities": [{"body": "hammer", "velocity": [3.0, 0.0], "spin": 10.0}],
    }
    del case["stages"][2]
    simulation = carom.Simulation(carom.Scenario.from_dict(case))
    simulation.advance(1.0)
    before = simulation.ledger.external
    assert largest(simulation, "velocity") == 0.0
    simulation.step()
    hammer = simulation.bodies["hammer"]
    np.testing.assert_allclose(hammer.velocity.mean(axis=0), [3.0, 0.0], atol=1e-12)
    mass, length = 7800.0 * 0.01**2, 0.01
    given = 0.5 * mass * 9.0 + 0.5 * mass * length**2 / 6.0 * 100.0
    assert simulation.ledger.external - before == pytest.approx(given, rel=1e-9)
    simulation.advance(1.00002)
    assert np.abs(simulation.history["defect"]).max() < 1e-11 * given


def test_plastic_strain_and_slip_go_on(tmp_path):
    case = staging.case()
    case["materials"]["steel"] = {
        "kind": "j2-plasticity",
        "young": 210e9,
        "poisson": 0.3,
        "density": 7800.0,
        "yield_stress": 9e6,
        "hardening": 1e9,
    }
    simulation = carom.Simulation(carom.Scenario.from_dict(case))
    simulation.advance(1.0)
    before = {name: simulation.bodies[name].plastic_strain for name in BODIES}
    assert before["lid"].max() > 1e-6
    simulation.step()
    for name in BODIES:
        now = simulation.bodies[name].plastic_strain
        assert (now >= before[name]).all()
        np.testing.assert_allclose(now, before[name], atol=1e-3 * before["lid"].max())
    simulation.advance(3.0)
    assert simulation.has_ended
    # What the return mapping leaves in steps that yield fast, as in a case without stages.
    assert np.abs(simulation.history["defect"]).max() < 1e-6 * simulation.ledger.external


def test_supports_have_a_column_in_every_stage(joint):
    """The force of a support is zero where there is none."""
    removed = [{"body": "block", "on": "right"}]
    led = [{"kind": "prescribed", "body": "block", "on": "right", "x": "1e-6*t"}]
    simulation = carom.Simulation(
        spring(static("led", 1.0, motions=led), static("free", 2.0, removed_motions=removed))
    )
    simulation.advance(2.0)
    force, stage = simulation.history["block.right.force_x"], simulation.history["stage"]
    assert force[stage == 1][-1] > 1e3
    assert (force[stage == 2] == 0.0).all()


def test_commands_tell_of_stages(joint, capsys):
    from carom import cli

    for command in (["check"], ["doctor"]):
        with pytest.raises(SystemExit) as left:
            cli.app([*command, str(joint.path / "case.toml")], prog_name="carom")
        assert left.value.code == 0
    said = capsys.readouterr().out
    assert "stage preload" in said
    assert "stages.1.analysis.time_step" in said
    with pytest.raises(SystemExit) as left:
        cli.app(["report", str(joint.path)], prog_name="carom")
    assert left.value.code == 0
    page = (joint.path / layout.REPORT).read_text(encoding="utf-8")
    (joint.path / layout.REPORT).unlink()
    assert "Books of the stages" in page
    assert list(joint.to_pandas("stages").index) == ["preload", "hit", "rest"]
    assert carom.audit(joint.path).refuted == ()


def test_a_single_stage_is_a_stage(joint):
    simulation = carom.Simulation(spring(static("pull", 1.0, loads=[PULL])))
    simulation.advance(1.0)
    assert set(simulation.history["stage"]) == {1.0}
    assert simulation.stage == "pull"
