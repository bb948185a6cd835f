"""Rigid bodies that touch obstacles, one another and deformable bodies, against closed forms."""

import math

import numpy as np
import pytest
from rigid_bodies import angular_momentum, column, run
from rolling_bodies import floor, rolling

import carom

RADIUS, MASS = 1.0, 2.0


def thrown(dimension, *, velocity, rate, restitution, friction):
    """A disc or a ball that meets the floor with a node right below its centre, in three steps."""
    # What turns on the way moves the node by ω Δt: the closed form is that of Δt → 0.
    step = 1e-11
    if dimension == 2:
        mesh = carom.Disc(centre=[0.0, RADIUS], radius=RADIUS, divisions=2)
        inertia, about = 0.5 * MASS * RADIUS**2, rate
    else:
        mesh = carom.Ball(centre=[0.0, 0.0, RADIUS], radius=RADIUS, divisions=2)
        inertia, about = (0.4 * MASS * RADIUS**2,) * 3, [0.0, -rate, 0.0]
    across, down = velocity
    body = carom.RigidBody(
        name="b",
        mass=MASS,
        inertia=inertia,
        mesh=mesh,
        velocity=[across, *[0.0] * (dimension - 2), -down],
        spin=about,
    )
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(end_time=3 * step, time_step=step),
        bodies=[body],
        obstacles=[floor(dimension)],
        contact=carom.Contact(condition="endpoint", friction=friction, restitution=restitution),
        output=carom.Output(history_every=step, fields_every=3 * step),
    )


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    ("law", "across", "rate"),
    [
        ((0.5, 0.2), 1.0, 3.0),  # slides throughout
        ((0.5, 0.2), 0.1, 0.3),  # its lowest point comes to rest
        ((1.0, 0.0), 1.0, 3.0),  # without friction nothing turns it
        ((0.0, 0.5), -1.0, -3.0),
        ((0.8, 0.1), -0.2, 0.4),
        ((0.9, 0.3), -0.5, 0.5),  # rolls already
    ],
)
def test_a_round_body_with_spin_bounces_as_moreau_says(tmp_path, dimension, law, across, rate):
    (restitution, friction), down = law, 1.0
    case = thrown(
        dimension, velocity=(across, down), rate=rate, restitution=restitution, friction=friction
    )
    history = run(tmp_path, case).history
    kappa = 3.0 if dimension == 2 else 3.5
    slip, push = across + rate * RADIUS, friction * (1.0 + restitution) * down
    slides = abs(slip) > kappa * push
    change = -math.copysign(push, slip) if slides else -slip / kappa
    vertical = history[f"b.v_{'xyz'[dimension - 1]}"][-1]
    turning = history["b.spin"][-1] if dimension == 2 else -history["b.spin_y"][-1]
    assert vertical == pytest.approx(restitution * down, abs=1e-10)
    assert history["b.v_x"][-1] == pytest.approx(across + change, abs=1e-10)
    assert turning == pytest.approx(rate + (kappa - 1.0) * change / RADIUS, abs=1e-10)
    assert np.abs(history["defect"]).max() < 1e-14 * history["total"][0]


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_rigid_block_on_an_incline_sticks_below_the_friction_angle_and_slides_above(
    tmp_path, condition, dimension
):
    """Closed form: it slides with g (sin α − μ cos α)."""
    gravity, friction, end = 9.81, 0.3, 0.5
    mesh = (
        carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 0.4], divisions=[2, 1])
        if dimension == 2
        else carom.Box(corner=[0.0, 0.0, 0.0], size=[1.0, 0.5, 0.4], divisions=[2, 1, 1])
    )
    for angle in (0.25, 0.5):
        down = np.zeros(dimension)
        down[0], down[-1] = math.sin(angle), -math.cos(angle)
        case = carom.Scenario(
            dimension=dimension,
            analysis=carom.Dynamic(end_time=end, time_step=5e-3, gravity=list(gravity * down)),
            bodies=[carom.RigidBody(name="block", density=1.0, mesh=mesh)],
            obstacles=[floor(dimension)],
            contact=carom.Contact(condition=condition, friction=friction),
            output=carom.Output(history_every=0.05, fields_every=end),
        )
        history = run(tmp_path, case).history
        pull = max(math.sin(angle) - friction * math.cos(angle), 0.0)
        moved = history["block.x"][-1] - history["block.x"][0]
        assert moved == pytest.approx(0.5 * gravity * pull * end**2, abs=1e-11)
        scale = gravity * max(moved, 1e-3) * 0.4
        assert np.abs(history["defect"]).max() < 1e-12 * scale
        normal = gravity * math.cos(angle) * (0.4 if dimension == 2 else 0.2)
        assert history["friction"][-1] == pytest.approx(friction * normal * moved, abs=1e-11)


@pytest.mark.parametrize("condition", ["midpoint", "gap", "endpoint"])
def test_a_rigid_mass_that_hits_an_elastic_bar_slows_down_exponentially(tmp_path, condition):
    """Closed form until the wave is back: v = v₀ exp(−ρ c A t/M) (Saint-Venant)."""
    young, density, length, height, mass, speed = 100.0, 1.0, 1.0, 0.1, 0.2, 0.01
    wave = math.sqrt(young / density)
    errors = []
    for cells in (20, 40):
        step = 0.5 * length / cells / wave
        steps = round(1.8 * length / wave / step)
        case = carom.Scenario(
            analysis=carom.Dynamic(end_time=steps * step, time_step=step),
            materials={"elastic": carom.LinearElastic(young=young, poisson=0.0, density=density)},
            bodies=[
                carom.Body(
                    name="bar",
                    material="elastic",
                    mesh=carom.Rectangle(
                        corner=[0.0, 0.0], size=[length, height], divisions=[cells, 1]
                    ),
                ),
                carom.RigidBody(
                    name="mass",
                    mass=mass,
                    mesh=carom.Rectangle(corner=[-0.1, 0.0], size=[0.1, height], divisions=[1, 1]),
                    velocity=[speed, 0.0],
                ),
            ],
            motions=[carom.Fixed(body="bar", on="right")],
            contact=carom.Contact(condition=condition),
            output=carom.Output(history_every=step, fields_every=steps * step),
        )
        history = run(tmp_path, case).history
        exact = speed * np.exp(-density * wave * height * np.asarray(history["time"]) / mass)
        errors.append(np.abs(history["mass.v_x"] - exact).max() / speed)
        assert np.abs(history["defect"]).max() < 1e-12 * history["total"][0]
    assert errors[1] < 5e-3
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_rigid_and_a_soft_body_keep_their_momenta_and_their_energy(tmp_path, dimension):
    """They meet askew, with friction, and part; nothing else acts."""
    if dimension == 2:
        soft_mesh = carom.Disc(centre=[0.0, 0.0], radius=0.5, divisions=4)
        hard_mesh = carom.Rectangle(corner=[0.52, -0.1], size=[0.6, 0.8], divisions=[2, 2])
        velocity, rate = [-1.0, 0.3], 0.5
    else:
        soft_mesh = carom.Box(corner=[-0.5] * 3, size=[1.0] * 3, divisions=[2] * 3)
        hard_mesh = carom.Box(corner=[0.52, -0.3, -0.1], size=[0.5] * 3, divisions=[1] * 3)
        velocity, rate = [-1.0, 0.3, 0.1], [0.3, 0.2, 0.4]
    elastic = carom.NeoHookean(young=100.0, poisson=0.3, density=1.0)
    case = carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(end_time=0.4, time_step=2e-3),
        materials={"elastic": elastic},
        bodies=[
            carom.Body(name="soft", material="elastic", mesh=soft_mesh),
            carom.RigidBody(name="hard", density=2.0, mesh=hard_mesh, velocity=velocity, spin=rate),
        ],
        contact=carom.Contact(condition="midpoint", friction=0.3),
        output=carom.Output(history_every=0.02, fields_every=0.4),
    )
    result = run(tmp_path, case)
    history, axes = result.history, "xyz"[:dimension]
    assert result.summary["contacts"], "they meet"
    momentum = column(history, *(f"momentum_{axis}" for axis in axes))
    size = np.linalg.norm(momentum[0])
    assert np.abs(momentum - momentum[0]).max() < 1e-12 * size
    turning = column(history, "angular_momentum") if dimension == 2 else angular_momentum(history)
    # A reaction acts on a node and on the point that it faces: on landing these are apart.
    assert np.abs(turning - turning[0]).max() < 2e-4 * size
    assert np.abs(history["defect"]).max() < 1e-10 * history["total"][0]
    kept = np.asarray(history["total"]) + np.asarray(history["friction"])
    assert np.abs(kept - kept[0]).max() < 1e-8 * kept[0]
    assert history["friction"][-1] > 1e-4 * kept[0]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("condition", ["midpoint", "endpoint"])
def test_a_stack_of_twenty_stands(tmp_path, dimension, condition):
    height = 20
    shape = carom.Rectangle if dimension == 2 else carom.Box
    bodies = [
        carom.RigidBody(
            name=f"b{k}",
            density=1.0,
            mesh=shape(
                corner=[0.0] * (dimension - 1) + [float(k)],
                size=[1.0] * dimension,
                divisions=[1] * dimension,
            ),
        )
        for k in range(height)
    ]
    end, step = 0.05, 1e-3
    case = carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=end, time_step=step, gravity=[0.0] * (dimension - 1) + [-9.81]
        ),
        bodies=bodies,
        obstacles=[floor(dimension)],
        contact=carom.Contact(
            condition=condition,
            friction=0.5,
            # There are many more reactions than it takes: solvers creep towards their last digits.
            solver=carom.FrictionSolver(tolerance=1e-10),
            certificate_tolerance=1e-7,
        ),
        output=carom.Output(history_every=end / 5, fields_every=end),
    )
    result = run(tmp_path, case)
    moved = np.abs(result.fields["displacement"][-1]).max()
    assert moved < 1e-9
    assert not result.warnings
    # The floor bears them all.
    assert result.history["normal_force"][-1] > 0.999 * 9.81 * sum(range(1, height + 1))


def test_a_block_that_drops_flat_without_restitution_stays(tmp_path):
    """Moreau's law with e = 0 takes all that it has, before it is in the floor.

    Symptom guarded against: it was stopped once it was there, and stayed a step's way inside. What
    rests is as far above as it would fall in a step and a half.
    """
    drop, step = 0.05, 1e-3
    block = carom.Rectangle(corner=[0.0, drop], size=[1.0, 1.0], divisions=[1, 1])
    case = carom.Scenario(
        analysis=carom.Dynamic(end_time=0.2, time_step=step, gravity=[0.0, -9.81]),
        bodies=[carom.RigidBody(name="block", density=1.0, mesh=block)],
        obstacles=[floor(2)],
        contact=carom.Contact(condition="endpoint", friction=0.5),
        output=carom.Output(history_every=step, fields_every=0.2),
    )
    history = run(tmp_path, case).history
    lowest = min(history["block.y"]) - 0.5
    assert 0.0 <= lowest < 1.5 * 9.81 * step**2
    assert max(history["penetration"]) == 0.0
    assert history["kinetic"][-1] < 1e-20
    taken = history["normal_contact"][-1]
    assert taken == pytest.approx(9.81 * (drop - lowest), rel=1e-12)


@pytest.mark.parametrize(
    ("contact", "message"),
    [
        ({"condition": "midpoint", "restitution": 0.5}, 'write condition = "endpoint"'),
        (
            {
                "condition": "endpoint",
                "pairs": [{"between": ["soft", "floor"], "restitution": 0.5}],
            },
            "'soft' deforms|\"soft\" deforms",
        ),
        ({"condition": "endpoint", "restitution": 1.5}, "must be at most 1"),
    ],
)
def test_a_restitution_is_of_what_is_rigid_and_of_velocities(tmp_path, contact, message):
    square = {"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 1.0], "divisions": [1, 1]}
    beside = {**square, "corner": [2.0, 0.0]}
    case = {
        "analysis": {"end_time": 1e-3, "time_step": 1e-3},
        "materials": {
            "elastic": {"kind": "linear-elastic", "young": 1.0, "poisson": 0.3, "density": 1.0}
        },
        "bodies": [
            {"name": "soft", "material": "elastic", "mesh": square},
            {"kind": "rigid", "name": "hard", "density": 1.0, "mesh": beside},
        ],
        "obstacles": [{"kind": "plane", "name": "floor", "point": [0.0, 0.0], "normal": [0, 1]}],
        "contact": contact,
    }
    with pytest.raises(carom.InputError, match=message):
        run(tmp_path, carom.Scenario.from_dict(case))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("condition", ["midpoint", "endpoint"])
def test_a_round_body_rolls_on_without_loss(tmp_path, dimension, condition):
    result = run(tmp_path, rolling(dimension, length=2.0, condition=condition))
    history = result.history
    assert history["b.x"][-1] - history["b.x"][0] == pytest.approx(2.0, rel=1e-12)
    assert np.ptp(history["total"]) < 1e-12 * history["total"][0]
    assert not result.warnings


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_round_body_that_slides_comes_to_roll(tmp_path, dimension):
    """Closed form: friction stops the slip s after it has changed the speed by s/κ."""
    slip, kappa = 1.0, 3.0 if dimension == 2 else 3.5
    case = rolling(dimension, length=2.0, condition="endpoint", slip=slip, friction=0.3)
    history = run(tmp_path, case).history
    assert history["b.v_x"][-1] == pytest.approx(2.0 - slip / kappa, rel=1e-9)
    turning = -history["b.spin"][-1] if dimension == 2 else history["b.spin_y"][-1]
    assert turning * 0.1 == pytest.approx(history["b.v_x"][-1], rel=1e-9)


@pytest.mark.parametrize("dimension", [2, 3])
def test_two_round_bodies_meet_at_one_point(tmp_path, dimension):
    """Closed form: equal balls that meet head on without friction exchange their velocities."""
    shape = carom.Disc if dimension == 2 else carom.Ball
    aside = np.zeros(dimension)
    aside[:2] = 0.9, 0.6
    bodies = [
        carom.RigidBody(
            name=name,
            density=1.0,
            mesh=shape(centre=list(place), radius=0.5, divisions=2),
            round=True,
            velocity=list(velocity),
        )
        for name, place, velocity in (
            ("a", np.zeros(dimension), aside),
            ("b", aside, np.zeros(dimension)),
        )
    ]
    case = carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(end_time=0.2, time_step=1e-3),
        bodies=bodies,
        contact=carom.Contact(condition="endpoint", friction=0.0, restitution=1.0),
        output=carom.Output(history_every=0.2, fields_every=0.2),
    )
    history = run(tmp_path, case).history
    assert [history[f"b.v_{axis}"][-1] for axis in "xy"] == pytest.approx(aside[:2], rel=1e-12)
    assert [history[f"a.v_{axis}"][-1] for axis in "xy"] == pytest.approx([0, 0], abs=1e-12)


@pytest.mark.parametrize("cell", ["quad4", "tri3", "hex8", "tet4"])
@pytest.mark.parametrize("said", [{"density": 700.0}, {"mass": 3.0}])
def test_what_is_round_weighs_and_turns_as_the_disc_or_ball(tmp_path, cell, said):
    """Closed forms: π R² t or 4/3 π R³; ½ m R² or ⅖ m R²; the centre of the mesh."""
    dimension, radius = (2, 0.2) if cell in {"quad4", "tri3"} else (3, 0.2)
    centre, velocity = [0.3, -0.1, 0.5][:dimension], [0.7, 0.0, 0.0][:dimension]
    shape = carom.Disc if dimension == 2 else carom.Ball
    body = carom.RigidBody(
        name="b",
        **said,
        mesh=shape(centre=centre, radius=radius, divisions=1, rings=1, cell=cell),
        round=True,
        velocity=velocity,
        spin=3.0 if dimension == 2 else [1.0, 2.0, 2.0],
        **({"thickness": 0.5} if dimension == 2 else {}),
    )
    case = carom.Scenario(
        dimension=dimension, analysis=carom.Dynamic(end_time=1.0, time_step=0.1), bodies=[body]
    )
    history = run(tmp_path, case).history
    volume = 0.5 * np.pi * radius**2 if dimension == 2 else 4 / 3 * np.pi * radius**3
    mass = said.get("mass", 700.0 * volume)
    assert history["momentum_x"][0] == pytest.approx(0.7 * mass, rel=1e-13)
    assert [history[f"b.{x}"][0] for x in "xyz"[:dimension]] == pytest.approx(centre, abs=1e-15)
    turning = (0.5 if dimension == 2 else 0.4) * mass * radius**2 * 3.0**2 / 2
    assert history["total"][0] == pytest.approx(0.5 * mass * 0.7**2 + turning, rel=1e-13)
    # What turns about its centre of mass goes straight.
    assert history["b.x"][-1] == pytest.approx(0.3 + 0.7, rel=1e-13)
    assert history["b.y"] == pytest.approx(-0.1, abs=1e-14)
    if "mass" in said:
        own = 0.7 * 3.0 * radius**2
        given = own if dimension == 2 else (own,) * 3
        case = case.model_copy(update={"bodies": (body.model_copy(update={"inertia": given}),)})
        other = run(tmp_path, case).history
        expected = 0.5 * 3.0 * 0.7**2 + own * 3.0**2 / 2
        assert other["total"][0] == pytest.approx(expected, rel=1e-13), "what is given counts"


def test_a_round_ring_around_the_axis_has_the_mass_of_a_torus(tmp_path):
    """Closed form: 2 π² x R² (Pappus)."""
    body = carom.RigidBody(
        name="b",
        density=2.0,
        hypothesis="axisymmetric",
        mesh=carom.Disc(centre=[0.5, 0.1], radius=0.1, divisions=1, rings=1),
        round=True,
        velocity=[0.0, -1.0],
    )
    case = carom.Scenario(analysis=carom.Dynamic(end_time=0.1, time_step=0.1), bodies=[body])
    history = run(tmp_path, case).history
    assert history["total"][0] == pytest.approx(2.0 * np.pi**2 * 0.5 * 0.1**2, rel=1e-13)
    assert history["b.y"][0] == pytest.approx(0.1, abs=1e-15)


def test_what_has_corners_is_not_round():
    with pytest.raises(carom.InputError, match="is of bodies whose mesh is a disc or a ball"):
        carom.RigidBody(
            name="b",
            density=1.0,
            mesh=carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 1.0], divisions=[1, 1]),
            round=True,
        )


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("rate", [-200.0, 0.0, 50.0])
@pytest.mark.parametrize("given", [0.2, 0.6])
def test_the_restitution_of_what_spins_is_that_of_its_law(tmp_path, dimension, rate, given):
    """Whatever the step. Symptom guarded against: a ball that spins by 200 rad/s and bounces at 0.6
    was said to bounce at 2.6, as the node that met the floor had turned on by the end of the step.
    """
    radius, speed, friction = 0.03, 1.0, 0.1
    centre = [0.0] * (dimension - 1) + [radius + 0.0105]
    kind = carom.Disc if dimension == 2 else carom.Ball
    body = carom.RigidBody(
        name="b",
        density=1000.0,
        mesh=kind(centre=centre, radius=radius, divisions=2),
        round=True,
        velocity=[0.0] * (dimension - 1) + [-speed],
        spin=rate if dimension == 2 else [0.0, -rate, 0.0],
    )
    case = carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(end_time=0.02, time_step=1e-3),
        bodies=[body],
        obstacles=[floor(dimension)],
        contact=carom.Contact(condition="endpoint", restitution=given, friction=friction),
    )
    impact = run(tmp_path, case).summary["contacts"][0]["impact"]
    assert impact["approach"] == pytest.approx(speed, rel=1e-9)
    assert impact["restitution"] == pytest.approx(given, abs=1e-9)
    slip = abs(rate) * radius
    assert impact["sliding"] == pytest.approx(slip, abs=1e-9)
    if rate != 0.0:
        kappa = 3.0 if dimension == 2 else 3.5
        lost = min(kappa * friction * (1 + given) * speed, slip)
        assert impact["tangential_restitution"] == pytest.approx(lost / slip - 1, abs=1e-9)


def test_what_many_bricks_make_of_a_hit_is_known_as_well_as_what_hit_them(tmp_path):
    """Symptom guarded against: steps of many iterations went on without inertia.

    Bodies had the stiffness that stands for it in load steps instead. By it they moved for
    kilometres, and what the tolerance left of that, times the reactions, was 0.1 J here.
    """
    length, height = 0.2, 0.1
    bricks = [
        carom.RigidBody(
            name=f"brick-{course}-{column}",
            density=2000.0,
            mesh=carom.Rectangle(
                corner=[length * (column + 0.5 * (course % 2)), height * course],
                size=[length, height],
                divisions=[2, 1],
            ),
        )
        for course in range(8)
        for column in range(3)
    ]
    ball = carom.RigidBody(
        name="ball",
        density=7800.0,
        mesh=carom.Disc(centre=[-0.25, 0.45], radius=0.12, divisions=8),
        velocity=[6.0, 0.0],
    )
    scenario = carom.Scenario(
        analysis=carom.Dynamic(end_time=0.03, time_step=1e-3, gravity=[0.0, -9.81]),
        bodies=[*bricks, ball],
        obstacles=[carom.Plane(name="ground", point=[0.0, 0.0], normal=[0.0, 1.0])],
        contact=carom.Contact(condition="endpoint", friction=0.5),
    )
    summary = carom.run(scenario, out=tmp_path).summary
    certificate = summary["certificate"]
    # Measured: 2.2e-8 J of 6.3 kJ.
    assert certificate["max_joule"] < 1e-10 * summary["energy"]["initial"]
    assert certificate["reference_joule"] < 1.01 * summary["energy"]["initial"]
