"""What the core alone can see, because it needs meshes and loads: key, place and remedy."""

import pytest

import carom
from carom import InputError
from carom.building.build import build

MATERIAL = {"kind": "saint-venant-kirchhoff", "young": 1e5, "poisson": 0.3, "density": 1e3}
BLOCK = {"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 1.0], "divisions": [2, 2]}
FLOOR = {"name": "floor", "kind": "plane", "point": [0.0, -1.0], "normal": [0.0, 1.0]}
PUSH = {"kind": "prescribed", "body": "block", "on": "top"}
STATIC = {"kind": "static", "end_time": 1.0, "time_step": 0.5}
ABOVE = {**BLOCK, "corner": [0.0, 2.0]}


def formula(text):
    """A pressure over time."""
    return {"loads": [{"kind": "pressure", "body": "block", "on": "all", "pressure": text}]}


def fitted(**contact):
    """A static case with this law of contact."""
    return {"analysis": STATIC, "contact": contact}


TOUCHING = {"bodies.1": {"name": "other", "material": "elastic", "mesh": ABOVE}}

BAD = [
    # what of the case is replaced, the beginning of the message, a part of it
    (
        {"motions": [{**PUSH, "on": "tpo", "y": "0*t"}]},
        "motions.0.on: ",
        "has no such set; known are ",
    ),
    ({"motions": [{**PUSH, "y": 0.1}]}, "motions.0.y: ", "let it grow from 0, as t*"),
    (
        {
            "motions": [
                {**PUSH, "y": "-t"},
                {"kind": "fixed", "body": "block", "on": "left"},
            ]
        },
        "motions.1",
        "moves it along y differently; leave that component out of one of them",
    ),
    ({"motions": [{**PUSH, "y": "sqrt(t)"}]}, "motions.0.y: ", "m/s: it must be finite"),
    (
        {"loads": [{"kind": "pressure", "body": "block", "on": "all", "pressure": "1/(t-t)"}]},
        "loads.0.pressure: ",
        "it must be finite",
    ),
    (
        {"obstacles": [{**FLOOR, "point": [0.0, 0.5]}]},
        "bodies.0.mesh: ",
        "move the body or turn the normal of obstacles.0",
    ),
    (
        {"bodies.1": {"name": "other", "material": "elastic", "mesh": BLOCK}},
        "bodies.0.mesh: ",
        "overlap at the start: ",
    ),
    (
        {"bodies.0.mesh": {**BLOCK, "corner": [-0.5, 0.0]}, "bodies.0.hypothesis": "axisymmetric"},
        "bodies.0.mesh: ",
        "has a negative radius; the axis of an axisymmetric body is x = 0, with the body at x ≥ 0",
    ),
    (
        {"bodies.0.mesh": {**BLOCK, "cell": "quad8"}, "bodies.0.formulation": "mean-dilatation"},
        "bodies.0.formulation: ",
        "quadratic cells hardly lock; leave the formulation out",
    ),
    (
        {"bodies.0.mesh": {**BLOCK, "cell": "tri3"}, "bodies.0.formulation": "mean-dilatation"},
        "bodies.0.formulation: ",
        "mesh the body with quad4, hex8 or quadratic cells",
    ),
    (
        {
            "materials.elastic": {**MATERIAL, "kind": "j2-plasticity", "yield_stress": 1e3},
            "bodies.0.hypothesis": "plane-stress",
        },
        "bodies.0.hypothesis: ",
        "has no plane-stress hypothesis; choose another hypothesis or leave it out",
    ),
    (
        {"output.track": [{"name": "far", "body": "block", "point": [5.0, 5.0]}]},
        "output.track.0.point: ",
        "give a point of it in the reference configuration",
    ),
    (
        {"bodies.0.hypothesis": "plane-stress", "bodies.0.formulation": "mean-dilatation"},
        "bodies.0.formulation: ",
        "a sheet in plane stress does not lock; leave the formulation out",
    ),
    (
        {
            "materials.elastic": {**MATERIAL, "kind": "linear-elastic"},
            "bodies.0.formulation": "mean-dilatation",
        },
        "bodies.0.formulation: ",
        "it needs a law of large displacements, such as saint-venant-kirchhoff",
    ),
    (
        {"obstacles": [{**FLOOR, "point": [0.0, 2.0]}]},
        "bodies.0.mesh: ",
        'lies outside, behind obstacle "floor" at the start: near (0.000000, 0.000000) it is 2',
    ),
    (
        {"obstacles": [{"name": "hole", "kind": "sphere", "centre": [0.5, 0.5], "radius": 2.0}]},
        "bodies.0.mesh: ",
        "move the body or set or leave out `cavity` of obstacles.0",
    ),
    (
        {"obstacles": [{"name": "step", "kind": "box", "corner": [0, 0.5], "size": [1, 1]}]},
        "bodies.0.mesh: ",
        'body "block" overlaps obstacle "step" at the start: near ',
    ),
    (
        {"bodies.0.hypothesis": "axisymmetric", "analysis.gravity": [1.0, 0.0]},
        "analysis.gravity: ",
        'has a part across the axis of body "block"; let it point along y',
    ),
    (
        {"bodies.0.hypothesis": "axisymmetric", "bodies.0.velocity": [1.0, 0.0]},
        "bodies.0.velocity: ",
        "a body of revolution moves along its axis; give [0, v]",
    ),
    (
        {"bodies.0.hypothesis": "axisymmetric", "bodies.0.spin": 1.0},
        "bodies.0.spin: ",
        "1: an axisymmetric body cannot spin; give 0",
    ),
    ({"motions": [{**PUSH, "z": 0.0}]}, "motions.0.z: ", "there are 2 dimensions; leave it out"),
    (
        {"motions": [{"kind": "fixed", "body": "block", "on": "left", "components": ["z"]}]},
        "motions.0.components: ",
        '"z": there are 2 dimensions',
    ),
    (
        {"analysis": STATIC, "contact.condition": "midpoint"},
        "contact.condition: ",
        'a static analysis rules the gap at the end of the step; write condition = "gap"',
    ),
    (
        {"analysis": STATIC, "bodies.0.velocity": [1.0, 0.0]},
        "bodies.0.velocity: ",
        "a static analysis knows no velocities; leave it out",
    ),
    (
        {
            "bodies.0.mesh": {**BLOCK, "periodic": True},
            "bodies.1": {"name": "other", "material": "elastic", "mesh": ABOVE},
            "contact.discretisation": "mortar",
        },
        "contact.discretisation: mortar: ",
        'body "block" is periodic; choose "node-to-segment"',
    ),
    (
        {
            "bodies.1": {"name": "other", "material": "elastic", "mesh": ABOVE},
            "contact.discretisation": "mortar",
            "contact.sources": "both",
        },
        "contact.discretisation: mortar: ",
        'one side has the multipliers; choose "finer", "first" or "second" for sources',
    ),
    (formula("2 t"), "loads.0.pressure: ", 'expected an operator at column 3 of "2 t"'),
    (formula("(" * 70), "loads.0.pressure: ", "nested deeper than 64 levels at column 65 of"),
    (formula("1e999"), "loads.0.pressure: ", '"1e999" is not a finite number at column 1 of'),
    (formula("1.2.3"), "loads.0.pressure: ", '"1.2.3" is not a number at column 1 of'),
    (
        formula("2*sin"),
        "loads.0.pressure: ",
        '"sin" is a function; give it an argument as in sin(t) at column 3 of',
    ),
    (formula("x"), "loads.0.pressure: ", 'unknown name "x"; known are t, pi, e at column 1 of'),
    (
        {"bodies.0.mesh": {**BLOCK, "divisions": [4000, 4000]}},
        "bodies.0.mesh",
        "it would have more than 5 million cells; take fewer divisions",
    ),
    # press fits
    (
        {**fitted(), **TOUCHING, "bodies.1.mesh": BLOCK},
        "bodies.0.mesh: ",
        "move one of them, or let the analysis take the overlap up by contact.resolve_overlap = tr",
    ),
    (
        {**fitted(resolve_overlap=True), **TOUCHING, "bodies.1.mesh": BLOCK},
        "bodies.0.mesh: ",
        "move one of them; contact takes up no more than half a facet",
    ),
    (
        {"contact.pairs": [{"between": ["block", "floor"], "interference": 1.5}]},
        "contact.pairs.0.interference: ",
        '"block" and "floor" are 1.000e0 m apart at the start, where it pushes them 1.500e0 m '
        'apart at once; let it grow with time, as "1.5e0*min(t/1e-3, 1)" does',
    ),
    (
        {"contact.pairs": [{"between": ["block", "floor"], "interference": "-t"}]},
        "contact.pairs.0.interference: -1: ",
        "m, a quarter of the smallest facet; give less clearance, or coarsen the mesh",
    ),
    (
        {"contact.pairs": [{"between": ["block", "floor"], "interference": "1/(t-t)"}]},
        "contact.pairs.0.interference: ",
        "it must be finite",
    ),
    (
        {"contact.resolve_overlap": True},
        "contact.resolve_overlap: ",
        "overlaps are taken up in a static analysis; in a dynamic one, move the bodies apart and "
        "let `interference` grow",
    ),
    (
        {"contact.pairs": [{"between": ["block", "floor"], "resolve_overlap": True}]},
        "contact.pairs.0.resolve_overlap: ",
        "overlaps are taken up in a static analysis",
    ),
    (
        fitted(overlap_resolved_at=0.5),
        "contact.overlap_resolved_at: ",
        "no overlap is to be taken up; write resolve_overlap = true, or leave this out",
    ),
    (
        fitted(resolve_overlap=True, overlap_resolved_at=2.0),
        "contact.overlap_resolved_at: 2: ",
        "must be greater than 0 s and at most analysis.end_time",
    ),
    ({"bodies.0.growth": 0.1}, "bodies.0.growth: 0.1 at t = 0, ", "let it grow from 0, as t*0.1"),
    (
        {"bodies.0.growth": "20*t"},
        "bodies.0.growth: ",
        "growth is a linear strain, from -2/3 to 2; for a temperature T give alpha*T",
    ),
]


def case(changes):
    data = {
        "analysis": {"kind": "dynamic", "end_time": 1.0, "time_step": 0.01},
        "materials": {"elastic": dict(MATERIAL)},
        "bodies": [{"name": "block", "material": "elastic", "mesh": dict(BLOCK)}],
        "obstacles": [dict(FLOOR)],
        "contact": {},
        "output": {},
    }
    for path, value in changes.items():
        *way, last = [int(part) if part.isdecimal() else part for part in path.split(".")]
        place = data
        for part in way:
            place = place[part]
        if isinstance(place, list) and last == len(place):
            place.append(value)
        else:
            place[last] = value
    return carom.Scenario.from_dict(data)


def test_edges_through_one_another_are_named_though_no_node_is_inside():
    bar = {"kind": "box", "divisions": [1, 1, 1]}
    low = {**bar, "corner": [-1.0, 0.0, 0.0], "size": [6.0, 1.0, 1.0]}
    high = {**bar, "corner": [0.0, -1.0, 0.99], "size": [1.0, 6.0, 1.0]}
    changes = {"dimension": 3, "obstacles": [], "bodies.0.mesh": low}
    changes["bodies.1"] = {"name": "other", "material": "elastic", "mesh": high}
    said = r'edges of "block" and "other" are 0.010000 m through one another at the start, near \('
    with pytest.raises(InputError, match=said):
        build(case(changes))
    build(case({**changes, "bodies.1.mesh": {**high, "corner": [0.0, -1.0, 1.0]}}))


@pytest.mark.parametrize(("changes", "key", "part"), BAD)
def test_bad_input_that_needs_meshes_is_named_in_one_line(changes, key, part):
    with pytest.raises(InputError) as caught:
        build(case(changes))
    said = str(caught.value)
    assert said.startswith(key)
    assert part in said
    assert "\n" not in said


def test_a_static_body_that_nothing_holds_is_named():
    scenario = case(
        {
            "analysis": {"kind": "static", "end_time": 1.0, "time_step": 0.5, "gravity": [0, -1]},
            "obstacles": [],
            "contact.condition": "gap",
        }
    )
    with pytest.raises(
        carom.ConvergenceError, match=r"block.* is not held: it is free to .*support it"
    ):
        build(scenario).advance(1.0, 1.0)


PULL = {"kind": "pressure", "body": "block", "on": "top", "pressure": "-1e7*t", "follower": False}
FOLLOWING = {**PULL, "pressure": "-1e8*t", "follower": True}
RUBBER = {**MATERIAL, "kind": "neo-hookean"}
HELD = {"kind": "fixed", "body": "block", "on": "bottom"}


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        (
            {"loads": [{"kind": "force", "body": "block", "on": "top", "force": [0.0, 1e200]}]},
            r"the displacement is not finite$",
        ),
        (
            {"analysis": STATIC, "motions": [HELD], "loads": [PULL], "contact": {}},
            r"a body moves by \S+ m, and the largest is 1\.414e0 m large: the loads outgrow what b",
        ),
        (
            {"analysis": STATIC, "motions": [HELD], "loads": [FOLLOWING], "contact": {}},
            r'no state near the last one is in stable equilibrium: body "block" buckles, snaps t',
        ),
        (
            {
                "analysis": {**STATIC, "stabilisation": "dynamic"},
                "motions": [HELD],
                "loads": [FOLLOWING],
                "contact": {},
            },
            r'no state near the last one is .*, body "block" comes to rest in none: lower the load',
        ),
        (
            {"analysis.newton": {"max_iterations": 1}, "bodies.0.spin": 10.0},
            r"Newton's iterations stopped after 1 with a last correction of \S+ m \(wanted \S+ m\)",
        ),
    ],
)
def test_a_step_that_fails_says_why(changes, reason):
    said = r"^step at t = \S+ s failed with a length of \S+ s, after "
    for halvings in ("0 halvings: ", "1 halving: "):
        failing = build(case({**changes, "analysis.max_halvings": int(halvings[0])}))
        with pytest.raises(carom.ConvergenceError, match=said + halvings + reason):
            failing.advance(1.0, 10.0)


def test_a_step_that_fails_names_the_body_that_is_crushed():
    press = {"kind": "prescribed", "body": "block", "on": "top", "y": "-1.1*t"}
    crushing = case(
        {
            "analysis": {**STATIC, "time_step": 0.05},
            "materials.elastic": RUBBER,
            "motions": [HELD, press],
            "obstacles": [],
            "contact": {},
        }
    )
    said = r'; it starts with \d+ cells? of body "block" crushed to less than half, the worst to 0'
    with pytest.raises(carom.ConvergenceError, match=said):
        build(crushing).advance(1.0, 10.0)
