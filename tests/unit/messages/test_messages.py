"""Every kind of bad input that can be seen without building a mesh: key, value and remedy."""

import pytest

import carom
from carom import InputError, Scenario

ABSENT = object()

BAD = [
    # where, what, the message
    ("bodies.0.mesh.divsions", 8, "bodies.0.mesh.divsions: unknown key; did you mean"),
    (
        "bodies.0.mesh.divsions",
        8,
        '"divisions"? (known: kind, centre, radius, divisions, rings, cell)',
    ),
    ("contakt", {}, 'contakt: unknown key; did you mean "contact"?'),
    ("materials.elastic.density", -1, "materials.elastic.density = -1: must be greater than 0"),
    ("materials.elastic.density", ABSENT, "materials.elastic.density: required key is missing"),
    ("materials.elastic.poisson", 0.5, "materials.elastic.poisson = 0.5: must be less than 0.5"),
    ("materials.elastic.poisson", -1, "materials.elastic.poisson = -1: must be greater than -1"),
    ("materials.elastic.young", "5", 'materials.elastic.young = "5": must be a number'),
    ("materials.elastic.young", True, "materials.elastic.young = true: must be a number"),
    ("materials.elastic.kind", "linear", 'materials.elastic.kind = "linear": must be one of'),
    ("materials.elastic.kind", ABSENT, "materials.elastic.kind: required key is missing"),
    ("materials", ABSENT, 'bodies.0.material = "elastic": no such material; known: none'),
    ("materials.el astic", {}, "materials.el astic"),
    (
        "materials.elastic",
        {"kind": "mooney-rivlin", "c10": 1, "c01": -1.5, "bulk": 9, "density": 1},
        "materials.elastic.c01 = -1.5: c10 + c01, half the shear modulus, must be greater than 0",
    ),
    (
        "materials.elastic",
        {"kind": "ogden", "mu": [1.0, 2.0], "alpha": [2.0], "bulk": 9, "density": 1},
        "materials.elastic.alpha = [2.0]: must have as many entries as mu, 2",
    ),
    (
        "materials.elastic",
        {"kind": "ogden", "mu": [1.0], "alpha": [-2.0], "bulk": 9, "density": 1},
        "materials.elastic.mu = [1.0]: half the sum of mu times alpha",
    ),
    (
        "materials.elastic",
        {"kind": "ogden", "mu": [1.0], "alpha": [0.0], "bulk": 9, "density": 1},
        "materials.elastic.alpha = [0.0]: an exponent cannot be 0; leave the term out",
    ),
    (
        "materials.elastic",
        {
            "kind": "j2-plasticity",
            "young": 1,
            "poisson": 0,
            "density": 1,
            "yield_stress": 4,
            "saturation_stress": 3,
        },
        "saturation_stress = 3.0: the saturation stress cannot be below the yield stress",
    ),
    ("materials.elastic.viscosity", {"shear": -1}, "viscosity.shear = -1: must be at least 0"),
    (
        "materials.elastic",
        {"kind": "blatz-ko", "shear": 1, "poisson": 0.5, "density": 1},
        "materials.elastic.poisson = 0.5: must be less than 0.5",
    ),
    (
        "materials.elastic",
        {"kind": "yeoh", "c10": 0, "bulk": 9, "density": 1},
        "materials.elastic.c10 = 0: must be greater than 0",
    ),
    (
        "analysis.scheme",
        {"kind": "theta", "theta": 0},
        "analysis.scheme.theta = 0: must be greater than 0",
    ),
    (
        "analysis.scheme",
        {"kind": "theta", "xi": 1.5},
        "analysis.scheme.xi = 1.5: must be at most 1",
    ),
    ("analysis.scheme", {"theta": 1}, "analysis.scheme.kind: required key is missing"),
    ("analysis.scheme", 1, "analysis.scheme = 1: must be a table"),
    ("analysis.time_step", 0.0, "analysis.time_step = 0.0: must be greater than 0"),
    ("analysis.time_step", -1e-3, "analysis.time_step = -0.001: must be greater than 0"),
    ("analysis.time_step", 2.0, "analysis.end_time = 1.0: must be at least one time_step (2 s)"),
    (
        "analysis.time_step",
        1e-300,
        "analysis.time_step = 1e-300: more than 1e+10 steps of that length go into 1 s; take a",
    ),
    ("analysis.time_step", 5e-324, "analysis.time_step = 5e-324: more than 1e+10 steps"),
    ("analysis.end_time", 1e308, "steps of that length go into 1e+308 s"),
    ("analysis.newton", {"tolerance": 0.1}, "analysis.newton.tolerance = 0.1: must be at most"),
    ("analysis.kind", "modal", "analysis.kind = \"modal\": must be one of 'dynamic', 'static'"),
    ("analysis.max_halvings", 1.5, "analysis.max_halvings = 1.5: must be an integer"),
    ("analysis.gravity", [0, -9.81, 0], "must have 2 components, not 3"),
    ("output.history_every", 1e-3, "output.history_every = 0.001: must be at least one analysis"),
    ("output.fields_every", 0, "output.fields_every = 0: must be greater than 0"),
    ("output.track.0.body", "lift", 'output.track.0.body = "lift": no such body; did you mean'),
    ("output.track.0.name", "left", 'output.track.0.name = "left": name already used by bodies'),
    ("bodies", [], "bodies = []: must have 1 or more entries, not 0"),
    ("bodies", ABSENT, "bodies: required key is missing; give bodies, or patterns of them"),
    ("bodies.0.material", "plastic", 'no such material; did you mean "elastic"? (known: elastic)'),
    ("bodies.0.velocity", [1.0], "bodies.0.velocity = [1.0]: must have 2 components, not 1"),
    ("bodies.0.velocity", 1.0, "bodies.0.velocity = 1.0: must be a list"),
    ("bodies.0.velocity", [1.0, "up"], 'bodies.0.velocity.1 = "up": must be a number'),
    (
        "bodies.0.mesh.divisions",
        7,
        "bodies.0.mesh.divisions = 7: must be even (take 8), or give rings",
    ),
    ("bodies.0.mesh.divisions", 8.0, "bodies.0.mesh.divisions = 8.0: must be an integer"),
    ("bodies.0.mesh.kind", "disk", 'bodies.0.mesh.kind = "disk": must be one of'),
    ("bodies.0.mesh.radius", 0, "bodies.0.mesh.radius = 0: must be greater than 0"),
    ("bodies.1.name", "left", 'bodies.1.name = "left": name already used by bodies.0.name'),
    ("bodies.1.name", "a.b", 'bodies.1.name = "a.b": a name has'),
    ("bodies.1.name", "a b", 'bodies.1.name = "a b": a name has'),
    ("bodies.1.name", "", 'bodies.1.name = "": a name has'),
    ("obstacles.0.name", "left", 'obstacles.0.name = "left": name already used'),
    ("obstacles.0.normal", [0, 0], "obstacles.0.normal = [0, 0]: must not be the zero vector"),
    ("obstacles.0.kind", "spere", "obstacles.0.kind = \"spere\": must be one of 'plane', 'sphere'"),
    (
        "obstacles.0",
        {"name": "ball", "kind": "sphere", "centre": [0, 9], "radius": 0},
        "obstacles.0.radius = 0: must be greater than 0",
    ),
    (
        "obstacles.0",
        {"name": "step", "kind": "box", "corner": [0, -2], "size": [1, -1]},
        "obstacles.0.size.1 = -1: must be greater than 0",
    ),
    (
        "obstacles.0",
        {"name": "pipe", "kind": "cylinder", "point": [0, 0, 0], "axis": [0, 0, 0], "radius": 1},
        "obstacles.0.axis = [0, 0, 0]: must not be the zero vector",
    ),
    ("contact.friction", -0.1, "contact.friction = -0.1: must be at least 0"),
    ("contact.friction", "rough", 'contact.friction = "rough": must be a number'),
    ("contact.friction", {"kinetic": -1}, "contact.friction.kinetic = -1: must be at least 0"),
    (
        "contact.friction",
        {"static": 0.2, "kinetic": 0.3},
        "contact.friction.static = 0.2: is less than kinetic = 0.3: what sticks would slide and be",
    ),
    (
        "contact.friction",
        {"static": 0.4, "kinetic": 0.3, "speed": 0.1, "distance": 1e-3},
        "contact.friction.distance = 0.001: static friction falls over a speed or over a distance",
    ),
    (
        "contact.pairs.0.friction",
        {"kinetic": 0.3, "speed": 0.1},
        "contact.pairs.0.friction.speed = 0.1: there is no static friction that could fall",
    ),
    (
        "contact.friction",
        {"reference": 0.6, "direct": 0.01, "evolution": 0.02, "speed": 0, "distance": 1e-5},
        "contact.friction.speed = 0: must be greater than 0",
    ),
    (
        "contact.friction",
        {"static": 0.3},
        "contact.friction.kinetic: required key is missing",
    ),
    ("contact.solver", {"kind": "nlgs"}, 'contact.solver.kind = "nlgs": must be \''),
    ("contact.pairs.0.between", ["left", "flor"], 'no such body or obstacle; did you mean "floor"'),
    ("title", 5, "title = 5: must be a string"),
    (
        "dimension",
        3,
        'bodies.0.mesh.kind = "disc": a disc is a body in 2D; set dimension = 2 at the',
    ),
    ("bodies.0.spin", [0, 0, 1], "bodies.0.spin = [0.0, 0.0, 1.0]: a spin in 2D is a number"),
    (
        "bodies.0.mesh",
        {
            "kind": "ring",
            "centre": [0, 4],
            "inner_radius": 1,
            "outer_radius": 1,
            "divisions": [8, 1],
        },
        "bodies.0.mesh.outer_radius = 1.0: must be greater than inner_radius (1 m)",
    ),
    (
        "bodies.0.mesh",
        {
            "kind": "ring",
            "centre": [0, 4],
            "inner_radius": 1,
            "outer_radius": 2,
            "divisions": [2, 1],
        },
        "bodies.0.mesh.divisions = [2, 1]: must begin with 3 cells around or more",
    ),
    (
        "bodies.0",
        {
            "name": "left",
            "material": "elastic",
            "mesh": {
                "kind": "rectangle",
                "corner": [0, 3],
                "size": [1, 1],
                "divisions": [2, 2],
                "periodic": True,
            },
            "spin": 1.0,
        },
        "bodies.0.spin = 1.0: a periodic body cannot spin; give 0",
    ),
    (
        "bodies.0.contact_sets",
        ["topp"],
        'bodies.0.contact_sets = "topp": no such set of facets; ',
    ),
    (
        "motions",
        [{"kind": "prescribed", "body": "left", "on": "all"}],
        "motions.0: give one of x, y, z at least; those left out are free",
    ),
    ("obstacles.0.motion", {}, "obstacles.0.motion: give one of x, y, z at least"),
    (
        "obstacles.0",
        {
            "name": "floor",
            "kind": "plane",
            "point": [0, 0],
            "normal": [0, 1],
            "velocity": [0, 1],
            "motion": {"y": "t"},
        },
        "obstacles.0.motion: give velocity or motion, not both",
    ),
    (
        "loads",
        [
            {
                "kind": "pressure",
                "body": "left",
                "on": "all",
                "pressure": {"time": [0, 1], "value": [0]},
            }
        ],
        "must have as many entries as time, 2",
    ),
    (
        "loads",
        [
            {
                "kind": "pressure",
                "body": "left",
                "on": "all",
                "pressure": {"time": [1, 0], "value": [0, 1]},
            }
        ],
        "loads.0.pressure.time = [1.0, 0.0]: must ascend",
    ),
    ("contact.pairs.0.between", ["left"], "must be two names"),
    ("contact.pairs.0.enabled", "yes", 'contact.pairs.0.enabled = "yes": must be true or false'),
]


def spoil(data, path, value):
    *way, last = [int(part) if part.isdecimal() else part for part in path.split(".")]
    for part in way:
        data = data[part]
    if value is ABSENT:
        del data[last]
    else:
        data[last] = value


@pytest.mark.parametrize(("path", "value", "message"), BAD)
def test_bad_input_is_named_in_one_line(box, path, value, message):
    spoil(box, path, value)
    with pytest.raises(InputError) as caught:
        Scenario.from_dict(box)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert "more problem" not in str(caught.value)
    assert caught.value.key == str(caught.value).split(" = ")[0].split(": ")[0]


NUMBERS = [
    "analysis.end_time",
    "analysis.time_step",
    "analysis.newton.tolerance",
    "analysis.scheme.theta",
    "analysis.scheme.xi",
    "analysis.gravity.1",
    "output.fields_every",
    "output.history_every",
    "output.merge_contacts",
    "output.track.0.point.0",
    "materials.elastic.young",
    "materials.elastic.poisson",
    "materials.elastic.density",
    "materials.elastic.damping.mass",
    "materials.elastic.damping.stiffness",
    "bodies.0.thickness",
    "bodies.0.velocity.0",
    "bodies.0.spin",
    "bodies.0.mesh.centre.0",
    "bodies.0.mesh.radius",
    "bodies.0.mesh.divisions",
    "obstacles.0.point.1",
    "obstacles.0.normal.0",
    "contact.friction",
    "contact.solver.tolerance",
    "contact.pairs.0.friction",
]


@pytest.mark.parametrize("number", [float("nan"), float("inf"), float("-inf")])
@pytest.mark.parametrize("path", NUMBERS)
def test_what_is_not_finite_is_refused_everywhere(scenario, path, number):
    given = [
        "analysis.gravity=[0, -9.81]",
        "bodies.0.velocity=[0, 1]",
        'analysis.scheme={kind="theta"}',
    ]
    data = scenario.with_overrides(given).model_dump(mode="json")
    spoil(data, path, number)
    with pytest.raises(InputError, match=rf"^{path} = [-+]?(nan|inf): must be") as caught:
        Scenario.from_dict(data)
    assert caught.value.key == path


def test_two_obstacles_are_no_pair(box):
    box["obstacles"].append({"name": "west", "kind": "plane", "point": [0, 0], "normal": [1, 0]})
    box["contact"]["pairs"] = [{"between": ["floor", "west"]}]
    with pytest.raises(InputError, match=r"contact\.pairs\.0\.between .*two obstacles never touch"):
        Scenario.from_dict(box)


def test_a_body_that_may_not_touch_itself_is_no_pair(box):
    box["contact"]["pairs"] = [{"between": ["left", "left"]}]
    Scenario.from_dict(box)
    box["bodies"][0]["self_contact"] = False
    with pytest.raises(InputError, match=r"between .*must be two different names"):
        Scenario.from_dict(box)


def test_a_pair_is_given_once_whatever_its_order(box):
    box["contact"]["pairs"].append({"between": ["right", "left"]})
    with pytest.raises(InputError, match=r"contact\.pairs\.1\.between = .*already given by"):
        Scenario.from_dict(box)


def test_a_hypothesis_of_the_plane_is_none_in_space(box):
    ball = {"kind": "ball", "centre": [0, 0, 0], "radius": 1.0, "divisions": 2}
    body = {"name": "ball", "material": "elastic", "mesh": ball, "hypothesis": "plane-stress"}
    space = {key: box[key] for key in ("analysis", "materials")}
    with pytest.raises(InputError, match=r"\.hypothesis = .*: is of 2D bodies; leave it out in 3D"):
        Scenario.from_dict({**space, "dimension": 3, "bodies": [body]})


def test_further_problems_are_counted(box):
    box["materials"]["elastic"].update(young=-1, density=-1)
    box["contact"]["friction"] = -1
    with pytest.raises(InputError, match=r"young = -1: .* \(and 2 more problems\)$"):
        Scenario.from_dict(box)


def test_a_part_names_its_own_key():
    with pytest.raises(InputError, match=r"^radius = -1: must be greater than 0") as caught:
        carom.Disc(centre=[0, 0], radius=-1, divisions=8)
    assert caught.value.key == "radius"


def test_a_part_of_the_wrong_class_is_refused(box):
    box["bodies"][0]["mesh"] = carom.Theta()
    with pytest.raises(InputError, match=r"^bodies\.0\.mesh"):
        Scenario.from_dict(box)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('title = "no end', "not TOML: Unexpected end of file"),
        ("title = 'a'\n\ntheta = \n", "line 3, column 9: not TOML: "),
        ("title = 'a'\ntitle = 'b'\n", 'not TOML: Key "title" already exists'),
    ],
)
def test_toml_syntax_errors_name_file_and_place(tmp_path, text, message):
    case = tmp_path / "case.toml"
    case.write_text(text)
    with pytest.raises(InputError) as caught:
        Scenario.from_toml(case)
    assert str(caught.value).startswith(f"{case}: ")
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_case_file_that_cannot_be_read_is_named(tmp_path):
    with pytest.raises(InputError, match=r"absent\.toml: cannot be read: No such file"):
        Scenario.from_toml(tmp_path / "absent.toml")
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"title = '\xff'")
    with pytest.raises(InputError, match=r"binary\.toml: not UTF-8 text, at byte 9; save it"):
        Scenario.from_toml(binary)


def test_a_case_file_of_a_windows_editor_is_read(tmp_path, scenario):
    case = tmp_path / "case.toml"
    case.write_bytes(b"\xef\xbb\xbf" + scenario.to_toml().replace("\n", "\r\n").encode())
    assert Scenario.from_toml(case) == scenario


def test_errors_in_a_case_file_name_it(tmp_path, scenario):
    case = tmp_path / "case.toml"
    case.write_text(scenario.to_toml().replace("radius", "radios"))
    with pytest.raises(InputError, match=r"case\.toml: bodies\.0\.mesh\.radios: unknown key"):
        Scenario.from_toml(case)


@pytest.mark.parametrize("name", ["a\x00b", "", "a b", "a/b", "a.b"])
def test_names_that_cannot_be_columns_or_files_are_refused(box, name):
    box["bodies"][0]["name"] = name
    with pytest.raises(InputError, match=r"bodies\.0\.name = .*printable character"):
        Scenario.from_dict(box)
