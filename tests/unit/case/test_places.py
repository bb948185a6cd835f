"""Springs of the case file: what Python refuses before the core sees it, and what it writes."""

import pytest

import carom

ENDS = [{"body": "block", "point": [0.0, 0.0]}, {"point": [0.0, 3.0]}]
CASE = {
    "dimension": 2,
    "analysis": {"end_time": 1.0, "time_step": 0.1},
    "bodies": [
        {
            "kind": "rigid",
            "name": "block",
            "mass": 1.0,
            "mesh": {
                "kind": "rectangle",
                "corner": [-0.5, -0.5],
                "size": [1, 1],
                "divisions": [1, 1],
            },
        }
    ],
    "obstacles": [{"kind": "plane", "name": "floor", "point": [0, -0.5], "normal": [0, 1]}],
}


def with_spring(**given):
    spring = {"name": "strut", "between": ENDS, "stiffness": 1.0, **given}
    return carom.Scenario.from_dict({**CASE, "springs": [spring]})


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"name": "floor"}, 'springs.0.name = "floor": name already used by obstacles.0.name'),
        ({"stiffness": None}, "give a stiffness, a table of forces, or a damping"),
        ({"stiffness": 0.0}, "give a stiffness, a table of forces, or a damping"),
        ({"stiffness": -1.0}, "springs.0.stiffness"),
        ({"damping": -1.0}, "springs.0.damping"),
        ({"free_length": -1.0}, "springs.0.free_length"),
        (
            {"force": {"elongation": [0, 1], "force": [0, 1]}},
            "springs.0.force: give a stiffness or a table of forces, not both",
        ),
        (
            {"stiffness": None, "force": {"elongation": [0, 0], "force": [0, 1]}},
            "springs.0.force.elongation = [0.0, 0.0]: must ascend",
        ),
        (
            {"stiffness": None, "force": {"elongation": [0, 1], "force": [0, 1, 2]}},
            "must have as many entries as elongation, 2",
        ),
        ({"between": [ENDS[0], {"body": "bloc", "point": [0, 0]}]}, "no such body; did you mean"),
        ({"between": [ENDS[0], {"obstacle": "wall", "point": [0, 0]}]}, "no such obstacle"),
        ({"between": [ENDS[0], {"point": [0, 0, 1]}]}, "must have 2 components, not 3"),
        ({"between": [ENDS[1], ENDS[1]]}, "neither place is of a body; attach one of them"),
        ({"between": [ENDS[0], {}]}, "give a point, or a set `on` a body"),
        ({"between": [ENDS[0], {"on": "left"}]}, "is a set of a body; name the body"),
        (
            {"between": [ENDS[0], {"body": "block", "obstacle": "floor", "point": [0, 0]}]},
            "a place is of a body or of an obstacle; leave one out",
        ),
    ],
)
def test_what_is_no_spring_is_refused(given, message):
    with pytest.raises(carom.InputError) as error:
        with_spring(**given)
    assert message in str(error.value)


def test_springs_are_written_as_they_are_read(tmp_path):
    case = with_spring(damping=0.5, free_length=2.0)
    file = tmp_path / "case.toml"
    file.write_text(case.to_toml())
    assert carom.Scenario.from_toml(file) == case
    assert case.with_overrides(["springs.0.stiffness=7"]).springs[0].stiffness == 7.0


def test_a_mass_is_at_one_place():
    for given in ({}, {"point": [0.0, 0.0], "on": "left"}):
        with pytest.raises(carom.InputError, match="a mass is at a point, or on a set"):
            carom.PointMass(body="block", mass=1.0, **given)
    with pytest.raises(carom.InputError, match="no such body"):
        mass = {"body": "bloc", "point": [0.0, 0.0], "mass": 1.0}
        carom.Scenario.from_dict({**CASE, "masses": [mass]})
