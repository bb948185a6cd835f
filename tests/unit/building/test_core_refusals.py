"""What the core refuses by itself: cases that Python would not let through.

Cases are JSON here, as the core reads them, so that no check of the package stands in front.
"""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from test_core_messages import BLOCK, case

from carom import InputError, MeshError
from carom._carom import Simulation

ELASTIC = {
    "density": 1e3,
    "damping": {"mass": 0.0, "stiffness": 0.0},
    "viscosity": {"shear": 0.0, "bulk": 0.0},
}
SPACE = {"dimension": 3, "obstacles": []}
DISC = {"kind": "disc", "centre": [0.0, 0.0], "radius": 1.0, "divisions": 4, "rings": None}
BALL = {**DISC, "kind": "ball", "centre": [0.0, 0.0, 0.0]}
RING = {
    "kind": "ring",
    "centre": [0.0, 0.0],
    "inner_radius": 0.5,
    "outer_radius": 1.0,
    "divisions": [8, 2],
}
CYLINDER = {
    "kind": "cylinder",
    "base": [0.0, 0.0, 0.0],
    "axis": [0.0, 0.0, 1.0],
    "radius": 1.0,
    "height": 1.0,
    "divisions": 4,
    "rings": None,
    "layers": 2,
}
SPHERE = {"kind": "sphere", "centre": [0.5, -2.0], "radius": 1.0, "cavity": False}
BOX = {"kind": "box", "corner": [0.0, -2.0], "size": [1.0, 1.0]}
SUPPORT = {"body": "block", "on": "left"}
SIGNAL = {"body": "block", "on": "top", "kind": "pressure", "follower": False}
TRACK = {"name": "tip", "body": "block", "point": [1.0, 1.0]}


def law(kind, **constants):
    return {"materials.elastic": {"kind": kind, **ELASTIC, **constants}}


def mesh(**given):
    return {"bodies.0.mesh": given}


def obstacle(**given):
    return {"obstacles": [{"name": "floor", **given}]}


def pipe(**given):
    return {**SPACE, **mesh(**{**CYLINDER, **given})}


def spring(**given):
    ends = [{"body": "block", "point": [1.0, 1.0]}, {"point": [3.0, 1.0]}]
    return {"springs": [{"name": "strut", "between": ends, "stiffness": 1.0, **given}]}


def tied_to(**place):
    return spring(between=[place, {"point": [3.0, 1.0]}])


REDUCED = {"bodies.0.kind": "reduced", "bodies.0.modes": 0}
J2 = {"young": 1e5, "poisson": 0.3, "yield_stress": 1e3, "hardening": 0.0, "saturation_rate": 0.0}
AGEING = {"reference": 0.6, "direct": 0.01, "evolution": 0.02, "speed": 1.0, "distance": 1.0}
RUBBER = {"c10": 1e3, "c20": 0.0, "c30": 0.0, "bulk": 1e5}

BAD = [
    # what of the case is replaced, key, the message or its beginning
    ({"dimension": 4}, "dimension", "4: the core was asked for 2"),
    ({"bodies": []}, "bodies", "there is no body; add one [[bodies]] table at least"),
    (
        {"bodies.0.material": "steel"},
        "bodies.0.material",
        'there is no material "steel"; known are ["elastic"]',
    ),
    (
        mesh(kind="file", file="part.msh", body=None, scale=1.0),
        "bodies.0.mesh.file",
        '"part.msh": pass the mesh of every body that comes from a file along with the scenario',
    ),
    (
        {**SPACE, **mesh(**DISC)},
        "bodies.0.mesh.kind",
        "a disc is no body in 3D; choose another shape or set `dimension`",
    ),
    (mesh(**BLOCK, cell="quad7"), "", 'there is no cell "quad7"'),
    # analysis and contact
    ({"analysis.time_step": 0}, "analysis.time_step", "0: the time step must be greater than 0 s"),
    ({"analysis.time_step": 1e-15}, "analysis.time_step", "1e-15: the run would have"),
    ({"analysis.time_step": 2}, "analysis.end_time", "1: the end time must be at least one time"),
    (
        {"analysis.start_time": -1.0},
        "analysis.start_time",
        "-1: the start must not be before 0 s",
    ),
    (
        {"analysis.scheme": {"kind": "theta", "theta": 0, "xi": 0.5}},
        "analysis.scheme.theta",
        "0: theta must be greater than 0 and at most 1",
    ),
    (
        {"analysis.scheme": {"kind": "theta", "theta": 0.5, "xi": 2}},
        "analysis.scheme.xi",
        "2: xi must be between 0 and 1",
    ),
    ({"analysis.max_halvings": 31}, "analysis.max_halvings", "31: at most 30 halvings make sense"),
    (
        {"analysis.newton.tolerance": 0},
        "analysis.newton.tolerance",
        "0: the tolerance must be greater than 0",
    ),
    (
        {"contact.solver.max_iterations": 0},
        "contact.solver.max_iterations",
        "0: at least 1 iteration is needed",
    ),
    ({"contact.friction": 2e3}, "contact.friction", "2000: friction must be between 0 and 1000"),
    (
        {"contact.friction": {"kinetic": -0.1}},
        "contact.friction.kinetic",
        "-0.1: friction must be between 0 and 1000",
    ),
    (
        {"contact.friction": {"static": 0.2, "kinetic": 0.3}},
        "contact.friction.static",
        "0.2: is less than kinetic = 0.3: what sticks would slide",
    ),
    (
        {"contact.friction": {"static": 0.3, "kinetic": 0.2, "speed": 1.0, "distance": 1.0}},
        "contact.friction.distance",
        "static friction falls over a speed or over a distance; leave one out",
    ),
    (
        {"contact.friction": {"kinetic": 0.2, "distance": 1.0}},
        "contact.friction.distance",
        "there is no static friction that could fall; give it by static",
    ),
    (
        {"contact.friction": {"static": 0.3, "kinetic": 0.2, "speed": 0.0}},
        "contact.friction.speed",
        "0: must be greater than 0",
    ),
    (
        {"contact.friction": {"kinetic": 0.2, "viscous": -1.0}},
        "contact.friction.viscous",
        "-1: must not be negative",
    ),
    (
        {"contact.friction": {**AGEING, "direct": -1.0}},
        "contact.friction.direct",
        "-1: must not be negative",
    ),
    (
        {"contact.friction": {**AGEING, "distance": 0.0}},
        "contact.friction.distance",
        "0: must be greater than 0",
    ),
    (
        {"contact.friction": {"formula": "0.1*t"}},
        "contact.friction.formula",
        'unknown name "t"; known are v, s, p, pi, e at column 5 of "0.1*t"',
    ),
    (
        {"contact.friction": {"formula": "v - 0.1"}},
        "contact.friction",
        "-0.1: friction must be between 0 and 1000",
    ),
    (
        {"output.history_every": 0},
        "output.history_every",
        "0: the interval must be greater than 0 s",
    ),
    ({"output.track": [{**TRACK, "body": "x"}]}, "output.track.0.body", 'there is no body "x"'),
    (
        {"output.track": [{**TRACK, "point": [0.0]}]},
        "output.track.0.point",
        "[0.0] must be 2 finite numbers",
    ),
    # velocities
    (
        {"bodies.0.kind": "reduced"},
        "bodies.0.modes",
        'body "block" is reduced; say how many modes it has beside those of its surface',
    ),
    (
        {**REDUCED, "bodies.0.hypothesis": "axisymmetric"},
        "bodies.0.hypothesis",
        'body "block" is reduced and cannot be one of revolution; choose "plane-strain"',
    ),
    (
        {**REDUCED, "bodies.0.growth": "0.1*t"},
        "bodies.0.growth",
        'body "block" is reduced and cannot grow; leave it out',
    ),
    (
        {
            **REDUCED,
            "bodies.0.initial_stress": {
                **dict.fromkeys(("xx", "yy", "zz", "xy", "yz", "xz"), 0.0),
                "xx": 1.0,
            },
        },
        "bodies.0.initial_stress",
        'body "block" is reduced and starts without stress; leave it out',
    ),
    (
        {**REDUCED, "bodies.0.mesh.periodic": True},
        "bodies.0.mesh.periodic",
        'body "block" is reduced and cannot be periodic; leave periodic out',
    ),
    (
        {**REDUCED, "bodies.0.mesh.divisions": [760, 1]},
        "bodies.0.contact_sets",
        'body "block" keeps 3044 displacements of its contact surface, more than 3000; name the',
    ),
    (
        {"bodies.0.velocity": [1.0]},
        "bodies.0.velocity",
        "[1.0] must have 2 components",
    ),
    ({"bodies.0.velocity": [1e200, 0]}, "bodies", "the initial energy is not finite; check veloc"),
    ({"bodies.0.spin": [0, 0, 1]}, "bodies.0.spin", "a spin in 2D is a number"),
    (
        {**SPACE, **mesh(**BALL), "bodies.0.spin": 1.0},
        "bodies.0.spin",
        "a spin in 3D is a list of 3 numbers",
    ),
    (
        {"bodies.0.spin": 1.0, "bodies.0.mesh.periodic": True},
        "bodies.0.spin",
        "1: a periodic body cannot spin; give 0",
    ),
    # loads, motions, obstacles
    (
        {"loads": [{**SIGNAL, "body": "x", "pressure": 1.0}]},
        "loads.0.body",
        'there is no body "x"; known are ["block"]',
    ),
    (
        {"loads": [{"body": "block", "on": "top", "kind": "force", "force": [1.0]}]},
        "loads.0.force",
        "must have 2 components, not 1",
    ),
    ({"motions": [{**SUPPORT, "kind": "prescribed"}]}, "motions.0", "give one of x, y, z at least"),
    (
        {
            "obstacles.0.velocity": [0.0, 0.0],
            "obstacles.0.motion": {"x": 0.0, "y": None, "z": None},
        },
        "obstacles.0.motion",
        "an obstacle has a velocity or a motion, not both; leave one out",
    ),
    (
        obstacle(**{**SPHERE, "radius": 0}),
        "obstacles.0.radius",
        "0: the radius must be greater than 0 m",
    ),
    (
        obstacle(**{**BOX, "size": [1, 0]}),
        "obstacles.0.size",
        "0: every side must be greater than 0 m",
    ),
    (
        obstacle(kind="polygon", points=[[0, -2], [1, -2]]),
        "obstacles.0.points",
        "2 corners enclose nothing; give three or more",
    ),
    (
        obstacle(kind="polygon", points=[[0, -2], [1, -2], [1, -1], [0, -2]]),
        "obstacles.0.points",
        "corner 3 is where the next one is; give it once, the last side closes by itself",
    ),
    (
        obstacle(kind="polygon", points=[[0, -2], [1, -2], [0.5, -2], [0, -1]]),
        "obstacles.0.points",
        "the sides at corner 1 lie on one another; leave it out",
    ),
    (
        obstacle(kind="polygon", points=[[0, -2], [1, -2], [0, -1], [1, -1]]),
        "obstacles.0.points",
        "the sides from corners 1 and 3 meet; give the corners in the order in which they follow",
    ),
    (
        {**SPACE, **mesh(**BALL), **obstacle(kind="polygon", points=[[0, -2], [1, -2], [1, -1]])},
        "obstacles.0.kind",
        "a polygon is an obstacle of the plane; in space take a box or a surface",
    ),
    (
        obstacle(kind="plane", point=[0, 0], normal=[0, 0]),
        "obstacles.0.normal",
        "0: the normal must not be zero and points to the free side",
    ),
    (
        {
            **SPACE,
            **mesh(**BALL),
            **obstacle(kind="cylinder", point=[9, 9, 9], axis=[0, 0, 0], radius=1.0, cavity=False),
        },
        "obstacles.0.axis",
        "0: the axis must not be zero",
    ),
    (
        obstacle(kind="cylinder", point=[0, 0, 0], axis=[0, 0, 1], radius=1.0, cavity=False),
        "obstacles.0.kind",
        "a cylinder is an obstacle in 3D; in the plane take a sphere, which is a circle there",
    ),
    # springs
    (
        spring(between=[{"body": "block", "point": [1.0, 1.0]}] * 2),
        "springs.0.between",
        "both places move as one, so that the spring does nothing; choose two that do not",
    ),
    (
        spring(between=[{"obstacle": "floor", "point": [0.0, 0.0]}, {"point": [3.0, 1.0]}]),
        "springs.0.between",
        "neither place is of a body; attach one of them to a body",
    ),
    (
        spring(
            between=[{"body": "block", "point": [1.0, 1.0]}, {"point": [1.0, 1.0]}],
            free_length=0.5,
        ),
        "springs.0.between",
        "its places are one and the same, so that its force has no direction; draw them apart, or",
    ),
    (
        spring(stiffness=-1.0),
        "springs.0.stiffness",
        "-1: must be a finite number, 0 at least",
    ),
    (
        spring(force={"elongation": [0, 1], "force": [0, 1]}),
        "springs.0.force",
        "a spring has a stiffness or a table of forces, not both; leave one out",
    ),
    (
        spring(stiffness=None, force={"elongation": [0], "force": [1]}),
        "springs.0.force",
        "1 elongations and 1 forces: give as many of one as of the other, 2 at least",
    ),
    (
        spring(stiffness=None, force={"elongation": [1, 0], "force": [0, 1]}),
        "springs.0.force",
        "elongation 0 follows 1: elongations must ascend",
    ),
    (
        spring(stiffness=0.0),
        "springs.0",
        "does nothing; give a stiffness, a table of forces, or a damping",
    ),
    (
        tied_to(body="block"),
        "springs.0.between.0",
        "a place is a body with a point or a set `on` it, an obstacle with a point, or a point",
    ),
    (
        tied_to(body="brick", point=[0.0, 0.0]),
        "springs.0.between.0.body",
        'there is no body "brick"; known are ["block"]',
    ),
    (
        tied_to(obstacle="wall", point=[0.0, 0.0]),
        "springs.0.between.0.obstacle",
        'there is no obstacle "wall"',
    ),
    (
        tied_to(body="block", on="lid"),
        "springs.0.between.0.on",
        '"lid": body "block" has no such set; known are [',
    ),
    (
        tied_to(body="block", point=[9.0, 9.0]),
        "springs.0.between.0.point",
        '[9.0, 9.0] is far from body "block"; give a point of it as it is drawn',
    ),
    (
        {**tied_to(body="block", point=[1.0, 1.0]), "bodies.0.hypothesis": "axisymmetric"},
        "springs.0.between.0.body",
        'body "block" is one of revolution, on which a spring would be a cone; leave it out',
    ),
    (
        {**tied_to(body="block", point=[0.5, 0.5]), **REDUCED},
        "springs.0.between.0.point",
        'node 4 of body "block" is inside; the body is reduced and takes forces at nodes of its',
    ),
    # masses at points
    (
        {"masses": [{"body": "brick", "point": [0.0, 0.0], "mass": 1.0}]},
        "masses.0.body",
        'there is no body "brick"; known are ["block"]',
    ),
    (
        {"masses": [{"body": "block", "point": [0.0, 0.0], "mass": 0.0}]},
        "masses.0.mass",
        "0: the mass must be greater than 0 kg",
    ),
    (
        {"masses": [{"body": "block", "mass": 1.0}]},
        "masses.0",
        "a mass is at a point, or on a set; give one of them",
    ),
    (
        {
            "masses": [{"body": "block", "point": [0.0, 0.0], "mass": 1.0}],
            "bodies.0.kind": "rigid",
            "bodies.0.mass": 1.0,
            "bodies.0.inertia": 1.0,
        },
        "masses.0.body",
        'body "block" has an inertia of its own, which tells of all its mass; leave one out',
    ),
    (
        {
            **mesh(**DISC),
            "masses": [{"body": "block", "point": [0.0, 0.0], "mass": 1.0}],
            "bodies.0.kind": "rigid",
            "bodies.0.mass": 1.0,
            "bodies.0.round": True,
        },
        "masses.0.body",
        'body "block" is round, with its centre of mass in the middle; leave round out',
    ),
    # functions of time
    (
        {"loads": [{**SIGNAL, "pressure": {"time": [0, 1], "value": [0]}}]},
        "loads.0.pressure",
        "2 times and 1 values: give as many of one as of the other, 1 at least",
    ),
    (
        {"loads": [{**SIGNAL, "pressure": {"time": [1, 0], "value": [0, 1]}}]},
        "loads.0.pressure",
        "time 0 follows 1: times must ascend",
    ),
    # materials
    (
        {"materials.elastic.density": 0},
        "materials.elastic.density",
        "density = 0: the density must be greater than 0 kg/m³",
    ),
    (
        {"bodies.0.thickness": 0},
        "bodies.0.thickness",
        "thickness = 0: the thickness must be greater than 0 m",
    ),
    (
        {"materials.elastic.damping.mass": -1},
        "materials.elastic.damping.mass",
        "damping.mass = -1: damping cannot be negative",
    ),
    (
        {"materials.elastic.viscosity.shear": -1},
        "materials.elastic.viscosity.shear",
        "viscosity.shear = -1: a viscosity cannot be negative",
    ),
    (
        {"materials.elastic.young": 0},
        "materials.elastic.young",
        "young = 0: Young's modulus must be greater than 0 Pa",
    ),
    (
        {"materials.elastic.poisson": 0.5},
        "materials.elastic.poisson",
        "poisson = 0.5: Poisson's ratio must be between -1 and 0.5, both excluded",
    ),
    (
        law("blatz-ko", shear=0, poisson=0.25, fraction=0.5),
        "materials.elastic.shear",
        "shear = 0: the shear modulus must be greater than 0 Pa",
    ),
    (
        law("blatz-ko", shear=1, poisson=0.5, fraction=0.5),
        "materials.elastic.poisson",
        "poisson = 0.5: Poisson's ratio of this law must be between 0 and 0.5, both excluded",
    ),
    (
        law("blatz-ko", shear=1, poisson=0.25, fraction=2),
        "materials.elastic.fraction",
        "fraction = 2: the fraction must be from 0 to 1",
    ),
    (
        law("j2-plasticity", **{**J2, "yield_stress": 0}),
        "materials.elastic.yield_stress",
        "yield_stress = 0: the yield stress must be greater than 0 Pa",
    ),
    (
        law("j2-plasticity", **{**J2, "hardening": -1}),
        "materials.elastic.hardening",
        "hardening = -1: the hardening cannot be negative",
    ),
    (
        law("j2-plasticity", **{**J2, "saturation_stress": 2e3, "saturation_rate": -1}),
        "materials.elastic.saturation_rate",
        "saturation_rate = -1: the rate of saturation cannot be negative",
    ),
    (
        law("j2-plasticity", **{**J2, "saturation_stress": 1}),
        "materials.elastic.saturation_stress",
        "saturation_stress = 1: the saturation stress cannot be below the yield stress",
    ),
    (
        law("mooney-rivlin", c10=1, c01=-2, bulk=9),
        "materials.elastic.c01",
        "c01 = -2: c10 + c01, half the shear modulus, must be greater than 0 Pa",
    ),
    (
        law("mooney-rivlin", c10=1, c01=1, bulk=0),
        "materials.elastic.bulk",
        "bulk = 0: the bulk modulus must be greater than 0 Pa",
    ),
    (
        law("yeoh", **{**RUBBER, "c10": 0}),
        "materials.elastic.c10",
        "c10 = 0: c10, half the shear modulus, must be greater than 0 Pa",
    ),
    (
        law("ogden", mu=[1.0], alpha=[1.0, 2.0], bulk=9),
        "materials.elastic.alpha",
        "alpha = 2: mu and alpha must have the same number of terms, one at least",
    ),
    (
        law("ogden", mu=[1.0], alpha=[0.0], bulk=9),
        "materials.elastic.alpha",
        "alpha = 0: an exponent cannot be 0; leave the term out",
    ),
    (
        law("ogden", mu=[1.0], alpha=[-2.0], bulk=9),
        "materials.elastic.mu",
        "mu = -1: half the sum of mu times alpha, the shear modulus, must be greater than 0 Pa",
    ),
    (
        {**SPACE, **mesh(**BALL), "bodies.0.hypothesis": "axisymmetric"},
        "bodies.0.hypothesis",
        'hypothesis "axisymmetric" is one of 2D bodies; leave it out in 3D',
    ),
    # shapes
    (
        mesh(**{**DISC, "radius": 0}),
        "bodies.0.mesh.radius",
        "radius = 0.0 makes no mesh: the radius must be greater than 0 m",
    ),
    (
        mesh(**{**DISC, "divisions": 3}),
        "bodies.0.mesh.divisions",
        "divisions = 3 makes no mesh: an even number, at least 2, is needed, or an explicit number",
    ),
    (
        mesh(**{**DISC, "rings": 0}),
        "bodies.0.mesh.rings",
        "rings = 0 makes no mesh: at least 1 ring is needed around the core",
    ),
    (
        {**SPACE, **mesh(**{**BALL, "divisions": 3})},
        "bodies.0.mesh.divisions",
        "divisions = 3 makes no mesh: an even number, at least 2, is needed, or an explicit number",
    ),
    (
        {**SPACE, **mesh(**{**BALL, "rings": 0})},
        "bodies.0.mesh.rings",
        "rings = 0 makes no mesh: at least 1 ring is needed around the core",
    ),
    (
        {**SPACE, **mesh(**{**BALL, "cell": "wedge6"})},
        "bodies.0.mesh.cell",
        'cell = "wedge6" makes no mesh: the sides of its core have cells on them that point in '
        "three directions; take hex or tet cells",
    ),
    (
        mesh(**{**BLOCK, "size": [1, 0]}),
        "bodies.0.mesh.size",
        "size = [1.0, 0.0] makes no mesh: every side must be longer than 0 m",
    ),
    (
        mesh(**{**BLOCK, "divisions": [0, 1]}),
        "bodies.0.mesh.divisions",
        "divisions = [0, 1] makes no mesh: at least 1 cell is needed in every direction",
    ),
    (
        mesh(**{**RING, "inner_radius": 0}),
        "bodies.0.mesh.inner_radius",
        "inner_radius = 0.0 makes no mesh: the inner radius must be greater than 0 m; a body with",
    ),
    (
        mesh(**{**RING, "outer_radius": 0.5}),
        "bodies.0.mesh.outer_radius",
        "outer_radius = 0.5 makes no mesh: the outer radius must be greater than the inner one",
    ),
    (
        mesh(**{**RING, "divisions": [2, 1]}),
        "bodies.0.mesh.divisions",
        "divisions = [2, 1] makes no mesh: at least 3 cells around and 1 in every other direction",
    ),
    (
        pipe(layers=0),
        "bodies.0.mesh.layers",
        "layers = 0 makes no mesh: at least 1 layer is needed",
    ),
    (
        pipe(axis=[0, 0, 0]),
        "bodies.0.mesh.axis",
        "axis = [0.0, 0.0, 0.0] makes no mesh: the axis must not be the zero vector",
    ),
    (
        pipe(height=0),
        "bodies.0.mesh.height",
        "height = 0.0 makes no mesh: the height must be greater than 0 m",
    ),
]


def spoiled(changes):
    """The case of test_core_messages as JSON, with entries replaced by their dotted paths."""
    data = json.loads(case({}).to_json())
    for path, value in changes.items():
        *way, last = [int(part) if part.isdecimal() else part for part in path.split(".")]
        place = data
        for part in way:
            place = place[part]
        place[last] = {"velocity": None, "motion": None, **value} if way == ["obstacles"] else value
    for entry in data["obstacles"]:
        entry.setdefault("velocity", None)
        entry.setdefault("motion", None)
    return json.dumps(data)


@pytest.mark.parametrize(("changes", "key", "message"), BAD)
def test_bad_input_is_named_by_the_core_too(changes, key, message):
    with pytest.raises(InputError) as caught:
        Simulation(spoiled(changes))
    assert str(caught.value).startswith(f"{key}: {message}" if key else "")
    assert message in str(caught.value)
    assert caught.value.key == key


FILE = {"bodies.0.mesh": {"kind": "file", "file": "part.msh", "body": None, "scale": 1.0}}
SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
ABOVE = obstacle(kind="plane", point=[0.0, 0.0, -1.0], normal=[0.0, 0.0, 1.0])


def part(points=SQUARE, cells=((0, 1, 2, 3),), kind="quad4", **sets):
    empty = {"node_sets": {}, "facet_sets": {}, "cell_sets": {}}
    given = {
        name: {key: np.array(v, dtype=np.int64) for key, v in s.items()} for name, s in sets.items()
    }
    if "facet_sets" in given:
        given["facet_sets"] = {key: [v] for key, v in given["facet_sets"].items()}
    blocks = [(kind, np.array(cells, dtype=np.int64).reshape(-1, len(cells[0]) if cells else 4))]
    return SimpleNamespace(
        points=np.array(points, dtype=float), blocks=blocks, **{**empty, **given}
    )


def squares(count):
    """Squares in a row that share nothing, as points."""
    return [[x + 2 * k, y] for k in range(count) for x, y in SQUARE]


TWO = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
TWO_CELLS = ((0, 1, 4, 3), (1, 2, 5, 4))
BAD_MESHES = [
    ({}, part(cells=()), "the mesh has no cells; a body needs at least one"),
    (
        {},
        part(cells=((0, 1, 2, 9),)),
        "cell 0 refers to node 9, but the mesh has 4 nodes (numbered",
    ),
    ({}, part([*SQUARE, [2, 2]]), "node 4 belongs to no cell and would have no mass; remove it"),
    (
        {},
        part([[0, 0], [1, 0], [1, 1], [0, float("nan")]]),
        "node 3 has a coordinate that is not finite; every coordinate must be a number in metres",
    ),
    (
        {},
        part(kind="tet4"),
        "tet4 cells cannot fill a body in 2D; use cells of dimension 2",
    ),
    (
        {},
        part(node_sets={"tip": [4]}),
        'the set "tip" refers to node 4, but the mesh has 4 (numbered from 0)',
    ),
    (
        {},
        part(cells=((0, 3, 2, 1),)),
        "cell 0 with nodes [0, 3, 2, 1] near [0.0, 0.0] is inverted; list its nodes counter-clock",
    ),
    (
        {},
        part(squares(3), [[4 * k, 4 * k + 3, 4 * k + 2, 4 * k + 1] for k in range(3)]),
        "is inverted, and so are 2 more: [1, 2]; list its nodes",
    ),
    (
        {},
        part(squares(7), [[4 * k, 4 * k + 3, 4 * k + 2, 4 * k + 1] for k in range(7)]),
        "is inverted, and so are 6 more, the first of them [1, 2, 3, 4, 5]; list its nodes",
    ),
    (
        {"bodies.0.contact_sets": []},
        part(),
        "name one set at least, or disable the pairs of the body",
    ),
    (
        {"bodies.0.contact_sets": ["seam"]},
        part(),
        '"seam": the mesh has no such set of facets; known are ["all"]',
    ),
    (
        {"bodies.0.contact_sets": ["seam"]},
        part(TWO, TWO_CELLS, facet_sets={"seam": [[1, 4]]}),
        '["seam"]: no facet of these sets is on the boundary',
    ),
    (
        {"loads": [{**SIGNAL, "on": "seam", "pressure": 1.0}]},
        part(TWO, TWO_CELLS, facet_sets={"seam": [[1, 4]]}),
        '"seam": no facet of this set is on the boundary',
    ),
]


@pytest.mark.parametrize(("changes", "given", "message"), BAD_MESHES)
def test_a_mesh_that_makes_no_body_is_named_with_the_place(changes, given, message):
    with pytest.raises(InputError) as caught:
        Simulation(spoiled({**FILE, **changes}), {"block": given})
    assert message in str(caught.value)


TETRAHEDRON = {
    "kind": "surface",
    "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
}
TWICE = [*TETRAHEDRON["triangles"], [0, 1, 2]]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"triangles": []}, "the surface has no triangles$"),
        ({"triangles": [[0, 1, 9]]}, "triangle 0 refers to a vertex beyond the 4 there are$"),
        (
            {"triangles": [[0, 1, 1]]},
            r"1 triangle without area, the first is number 0 at \(0\.0.*\); remove what has none$",
        ),
        (
            {"triangles": TETRAHEDRON["triangles"][1:]},
            "the surface is not closed: only one triangle is at 3 edges, the first from .*; close",
        ),
        (
            {"triangles": TWICE},
            "more than two triangles meet at 3 edges, the first from .*; the su",
        ),
        (
            {"triangles": [[0, 1, 2], *TETRAHEDRON["triangles"][1:]]},
            "neighbouring triangles turn in different senses at 3 edges, the first .*; orient all",
        ),
        (
            {"triangles": [t[::-1] for t in TETRAHEDRON["triangles"]]},
            "the triangles turn the wrong way: their normals point inwards; reverse them$",
        ),
    ],
)
def test_triangles_that_enclose_nothing_are_no_obstacle(change, message):
    with pytest.raises(MeshError, match=f"^obstacles\\.0: {message}"):
        Simulation(spoiled({**SPACE, **mesh(**BALL), **obstacle(**{**TETRAHEDRON, **change})}))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": np.zeros((4, 2))}, r"shape \(4, 2\) instead of \(4, 3\)"),
        ({"triangles": np.zeros((5, 4), dtype=np.int64)}, r"shape \(5, 4\) instead of \(5, 3\)"),
        ({"triangles": np.array([[0, 1, -1]])}, "-1 is no index"),
    ],
)
def test_arrays_that_are_no_triangles_are_refused(change, message):
    points, triangles = (np.array(TETRAHEDRON[name]) for name in ("vertices", "triangles"))
    arrays = {"points": points.astype(float), "triangles": triangles, **change}
    case = spoiled({**SPACE, **mesh(**BALL), **obstacle(**TETRAHEDRON)})
    with pytest.raises(ValueError, match=f"^{message}$"):
        Simulation(case, None, {"floor": SimpleNamespace(**arrays)})


def test_cubes_that_share_an_edge_alone_have_no_contact_surface():
    cube = np.array([[x, y, z] for z in (0, 1) for x, y in SQUARE])
    second = cube + np.array([1, 1, 0])
    points = np.vstack([cube, second[[1, 2, 3, 5, 6, 7]]])
    cells = [range(8), [2, 8, 9, 10, 6, 11, 12, 13]]
    given = part(points, cells, "hex8")
    message = r"more than two facets meet at 1 of its edges, the first from \(1\.0+, 1\.0+, 0\.0+\)"
    with pytest.raises(
        MeshError, match=f"the contact surface is not manifold: {message}.*join the"
    ):
        Simulation(spoiled({**SPACE, **FILE, **ABOVE}), {"block": given})


def test_a_reduced_body_is_not_in_pieces():
    cube = np.array([[x, y, z] for z in (0, 1) for x, y in SQUARE])
    given = part(np.vstack([cube, cube + np.array([3, 0, 0])]), [range(8), range(8, 16)], "hex8")
    with pytest.raises(MeshError, match="the cells do not hang together, so that parts of the bod"):
        Simulation(spoiled({**SPACE, **FILE, **ABOVE, **REDUCED}), {"block": given})


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (part([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]), "points have 3 columns, not 2"),
        (part(cells=((0, 1, 2),)), "no cell quad4 of 3 nodes"),
        (part(cells=((0, 1, 2, -1),)), "-1 is no index"),
    ],
)
def test_arrays_that_are_no_mesh_are_refused(given, message):
    with pytest.raises(ValueError, match=f"^{message}$"):
        Simulation(spoiled(FILE), {"block": given})


def test_the_healthy_case_is_taken():
    assert Simulation(spoiled({})).steps == 100
    assert Simulation(spoiled(FILE), {"block": part()}).steps == 100
