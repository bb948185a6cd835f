"""Bodies that are there many times."""

import math

import meshio
import pytest

import carom

DISC = {
    "name": "grain",
    "material": "rubber",
    "mesh": {"kind": "disc", "centre": [0.1, 0.2], "radius": 0.05, "divisions": 2},
    "velocity": [1.0, 0.0],
}


def case(at, body=DISC, **more):
    return carom.Scenario.from_dict(
        {
            "analysis": {"end_time": 0.01, "time_step": 1e-3},
            "materials": {
                "rubber": {
                    "kind": "saint-venant-kirchhoff",
                    "young": 1e6,
                    "poisson": 0.3,
                    "density": 1000.0,
                }
            },
            "patterns": [{"body": body, "at": at}],
            "obstacles": [
                {"name": "floor", "kind": "plane", "point": [0.0, -1.0], "normal": [0.0, 1.0]}
            ],
            **more,
        }
    )


def test_a_wall_is_laid_in_courses():
    grid = {"kind": "grid", "counts": [3, 2], "spacing": [0.2, 0.1], "shift": [0.1, 0.0]}
    brick = {
        "name": "brick",
        "kind": "rigid",
        "density": 2000.0,
        "mesh": {
            "kind": "rectangle",
            "corner": [0.0, 0.0],
            "size": [0.2, 0.1],
            "divisions": [2, 1],
        },
    }
    wall = case(grid, brick)
    assert [body.name for body in wall.bodies] == [f"brick-{k}" for k in range(1, 7)]
    corners = [body.mesh.corner for body in wall.bodies]
    expected = [(0.0, 0.0), (0.2, 0.0), (0.4, 0.0), (0.1, 0.1), (0.3, 0.1), (0.5, 0.1)]
    assert [pytest.approx(place) for place in expected] == corners


def test_random_copies_are_within_their_box_and_apart():
    box = {"corner": [0.0, 0.0], "size": [1.0, 1.0], "gap": 2e-3}
    pile = case(
        {"kind": "random", "count": 40, "scales": [0.5, 1.5], "speed": 2.0, "seed": 7, **box}
    )
    discs = [body.mesh for body in pile.bodies]
    radii = [disc.radius for disc in discs]
    assert min(radii) < 0.03
    assert 0.07 < max(radii) <= 0.075
    for k, disc in enumerate(discs):
        least = disc.radius + 2e-3 - 1e-15
        assert all(least <= x <= 1.0 - least for x in disc.centre)
        for other in discs[:k]:
            distance = math.dist(disc.centre, other.centre)
            assert distance >= disc.radius + other.radius + 2e-3 - 1e-15
    speeds = [math.dist(body.velocity, (1.0, 0.0)) for body in pile.bodies]
    assert 1.0 < max(speeds) <= 2.0
    again = case(
        {"kind": "random", "count": 40, "scales": [0.5, 1.5], "speed": 2.0, "seed": 7, **box}
    )
    assert again == pile


def test_places_are_read_from_a_file_and_kept(tmp_path):
    places = tmp_path / "places.csv"
    places.write_text("x, y, scale, vx, vy, spin\n0, 1, 1, 0, -1, 3\n2, 3, 0.5, 1, 0, -3\n")
    pile = case({"kind": "list", "file": str(places)})
    first, second = pile.bodies
    assert (first.mesh.centre, first.mesh.radius, first.velocity) == ((0, 1), 0.05, (0, -1))
    assert (second.mesh.centre, second.mesh.radius, second.spin) == ((2, 3), 0.025, -3)
    places.unlink()
    assert carom.Scenario.from_dict(pile.model_dump(mode="json")).bodies == pile.bodies


def test_a_case_file_says_patterns_and_not_what_they_make(tmp_path):
    grid = {"kind": "grid", "counts": [10, 10], "spacing": [0.11, 0.11], "jitter": 1e-3}
    pile = case(grid, contact={"pairs": [{"between": ["grain", "floor"], "friction": 0.5}]})
    assert len(pile.bodies) == len(pile.contact.pairs) == 100
    assert {pair.between[0] for pair in pile.contact.pairs} == {b.name for b in pile.bodies}
    for complete in (False, True):
        text = pile.to_toml(complete=complete)
        assert "grain-1" not in text
        file = tmp_path / "pile.toml"
        file.write_text(text)
        assert carom.Scenario.from_toml(file) == pile
        assert carom.Scenario.from_toml(file).to_json() == pile.to_json()
    assert len(pile.with_overrides(["patterns.0.at.counts=[2, 3]"]).bodies) == 6


def test_copies_of_a_mesh_file_are_where_they_are_put(tmp_path):
    points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
    meshio.write(tmp_path / "square.vtk", meshio.Mesh(points, {"quad": [[0, 1, 2, 3]]}))
    body = {
        "name": "square",
        "material": "rubber",
        "mesh": {"file": str(tmp_path / "square.vtk"), "move": [0.0, 5.0]},
    }
    grid = {"kind": "grid", "counts": [2, 1], "spacing": [3.0, 1.0]}
    bodies = carom.Simulation(case(grid, body)).bodies
    corners = [sorted(map(tuple, bodies[name].points.tolist())) for name in bodies]
    assert corners == [[(x, y) for x in (a, a + 1.0) for y in (5.0, 6.0)] for a in (0.0, 3.0)]


REFUSED = [
    (
        {"kind": "random", "count": 300, "corner": [0, 0], "size": [1, 1]},
        r"patterns\.0\.at\.count = 300: there is room for \d+ of 300; take a larger box",
    ),
    (
        {"kind": "random", "count": 3, "corner": [0, 0, 0], "size": [1, 1, 1]},
        r"patterns\.0\.at\.corner = .*: must have 2 components, not 3",
    ),
    (
        {"kind": "random", "count": 3, "corner": [0, 0], "size": [1, 1], "scales": [2, 1]},
        r"patterns\.0\.at\.scales = .*: must be the smallest size, then the largest",
    ),
    (
        {"kind": "grid", "counts": [300, 300], "spacing": [1, 1]},
        r"patterns\.0\.at = 90000: more than 46000 bodies have more pairs than there are numbers",
    ),
    ({"kind": "list"}, r"patterns\.0\.at\.places: give file or places"),
    (
        {"kind": "list", "places": [[0, 0], [1, 1]], "scales": [1.0]},
        r"patterns\.0\.at\.scales: must have as many entries as places \(2\), not 1",
    ),
    (
        {"kind": "list", "file": "no-such.csv"},
        r"patterns\.0\.at\.file = .*no-such\.csv.*: cannot be read: No such file",
    ),
    (
        {"kind": "list", "file": "no-such.csv", "places": [[0, 0]]},
        r"patterns\.0\.at\.file = .*: give file or places, one of the two",
    ),
]


@pytest.mark.parametrize(("at", "message"), REFUSED)
def test_places_that_cannot_be_are_refused(at, message):
    with pytest.raises(carom.InputError, match=message):
        case(at)


TABLES = [
    ("x,z\n1,2\n", "has no columns x and y; its first line names x, y, z"),
    ("x,y,colour\n1,2,3\n", "column 'colour' is not known; its first line names"),
    ("x,y\n1,up\n", "line 2: y must be a finite number, not 'up'"),
    ("x,y\n1,2\n3\n", "line 3: y must be a finite number, not None"),
    ("x,y,scale\n1,2,0\n", "line 2: scale must be greater than 0"),
]


@pytest.mark.parametrize(("text", "message"), TABLES)
def test_a_file_of_places_that_says_none_is_refused(tmp_path, text, message):
    file = tmp_path / "places.csv"
    file.write_text(text)
    with pytest.raises(carom.InputError, match=message):
        case({"kind": "list", "file": str(file)})


def test_what_is_said_of_copies_among_themselves_is_said_of_all():
    grid = {"kind": "grid", "counts": [2, 2], "spacing": [0.2, 0.2]}
    pairs = [{"between": ["grain", "grain"], "friction": 0.5}]
    with pytest.raises(carom.InputError, match="copies touch one another as contact itself says"):
        case(grid, contact={"pairs": pairs})


def test_a_mesh_of_unknown_size_has_no_random_places():
    at = {"kind": "random", "count": 3, "corner": [0, 0], "size": [1, 1]}
    body = {"name": "part", "material": "rubber", "mesh": {"file": "part.vtk"}}
    with pytest.raises(carom.InputError, match=r"patterns\.0\.at\.kind = \"random\": the size of"):
        case(at, body)


def test_names_of_copies_are_taken():
    grid = {"kind": "grid", "counts": [2, 2], "spacing": [0.2, 0.2]}
    other = {**DISC, "name": "grain-3"}
    with pytest.raises(carom.InputError, match="name already used by"):
        case(grid, bodies=[other])
