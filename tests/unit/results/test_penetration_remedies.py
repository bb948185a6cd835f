"""What is advised where something went into something can help there.

Symptoms guarded against: self_contact = false was said to forbid what it did not, sources = "both"
was advised where it was that already or against an obstacle, and nobody said that contact_sets
leave out what hits or that motions drive two into one another.
"""

import warnings

import pytest

import carom
from carom.results.penetration import depth_of

SQUARE = {"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 1.0], "divisions": [1, 1]}
LAW = {"kind": "saint-venant-kirchhoff", "young": 1e6, "poisson": 0.3, "density": 1e3}


def body(name, height=0.0, **more):
    return {"name": name, "material": "e", "mesh": {**SQUARE, "corner": [0.0, height]}, **more}


def case(one=None, other=None, **more):
    data = {
        "analysis": {"end_time": 1.0, "time_step": 0.01},
        "materials": {"e": LAW},
        "bodies": [body("a", **(one or {})), body("b", 1.1, **(other or {}))],
        "obstacles": [{"name": "floor", "kind": "plane", "point": [0, -1], "normal": [0, 1]}],
        **more,
    }
    return carom.Scenario.from_dict(data)


def advice(scenario, *between):
    worst = {"between": between, "depth": 0.02, "allowed": 0.01, "time": 0.5}
    return depth_of(worst, scenario).partition("penetration_tolerance: ")[2]


def test_crushed_cells_are_told_where_they_may_be_behind_it():
    worst = {"between": ["a", "b"], "depth": 0.02, "allowed": 0.01, "time": 0.5}
    told = depth_of({**worst, "crushed": {"body": "a", "cells": 1, "least": 0.156}}, case())
    assert "tolerance, with 1 cell of a crushed to less than half, the worst to 0.16 of" in told
    assert told.endswith(f"of what it was: {PLAIN}")
    told = depth_of({**worst, "crushed": {"body": "b", "cells": 2, "least": 0.3}}, case())
    assert "with 2 cells of b crushed" in told
    assert "crushed" not in depth_of({**worst, "crushed": None}, case())


FINER = "mesh more finely, take a smaller analysis.time_step"
PLAIN = "mesh more finely, or take a smaller analysis.time_step"


@pytest.mark.parametrize("allowed", [None, True])
def test_self_contact_is_to_blame_only_where_it_is_false(allowed):
    one = {} if allowed is None else {"self_contact": allowed}
    assert advice(case(one), "a", "a") == PLAIN
    assert advice(case({**one, "contact_sets": ["top"]}), "a", "a") == (
        f"{FINER}, or name all sides that meet in bodies.0.contact_sets, which leaves others out"
    )
    forbidden = case(other={"self_contact": False})
    assert advice(forbidden, "b", "b") == (
        f"{FINER}, or let it touch itself, which bodies.1.self_contact = false forbids"
    )
    assert advice(case(other={"kind": "reduced", "modes": 3}), "b", "b") == (
        f'{FINER}, or leave bodies.1.kind out: a body of kind "reduced" cannot touch itself'
    )


@pytest.mark.parametrize(
    ("contact", "key"),
    [
        ({}, None),
        ({"sources": "both"}, None),
        ({"sources": "first"}, "contact.sources"),
        ({"pairs": [{"between": ["b", "a"], "sources": "finer"}]}, "contact.pairs.0.sources"),
        ({"sources": "first", "pairs": [{"between": ["a", "b"], "sources": "both"}]}, None),
        ({"sources": "first", "discretisation": "mortar"}, None),
        ({"sources": "first", "cohesion": 1e3}, None),
    ],
)
def test_both_sides_are_advised_only_where_one_alone_is_checked_and_both_could(contact, key):
    scenario = case(contact=contact)
    expected = PLAIN if key is None else f'{FINER}, or check both sides, {key} = "both"'
    assert advice(scenario, "a", "b") == expected
    assert advice(scenario, "a", "floor") == PLAIN


def test_contact_sets_that_leave_sides_out_are_named():
    scenario = case({"contact_sets": ["left"]}, {"contact_sets": ["right"]})
    one, other = (
        f"name all sides that meet in bodies.{k}.contact_sets, which leaves others out"
        for k in (0, 1)
    )
    assert advice(scenario, "a", "floor") == f"{FINER}, or {one}"
    assert advice(scenario, "a", "b") == f"{FINER}, {one}, or {other}"


HELD = {"kind": "fixed", "body": "a", "on": "all"}
DRIVEN = {"kind": "prescribed", "body": "b", "on": "all", "x": 0.0, "y": "-0.5*t"}


def test_motions_that_leave_some_nodes_free_may_hold_those_that_meet():
    motions = [{**HELD, "on": "bottom"}, {**DRIVEN, "on": "top"}]
    assert advice(case(motions=motions), "a", "b") == (
        f"{FINER}, or leave free in motions.0, motions.1 the nodes that meet something"
    )
    assert advice(case(motions=motions[:1]), "a", "b") == PLAIN
    assert advice(case(motions=motions[:1]), "a", "floor") == (
        f"{FINER}, or leave free in motions.0 the nodes that meet something"
    )
    across = [{**HELD, "components": ["x"]}, DRIVEN]
    assert "motions.1 drives them" not in advice(case(motions=across), "a", "b")


def test_a_rigid_body_that_is_guided_and_an_obstacle_that_moves():
    data = case().model_dump(mode="json", exclude_none=True)
    data["bodies"][1] = {"name": "b", "kind": "rigid", "density": 1e3, "mesh": SQUARE}
    data["motions"] = [{"kind": "guided", "body": "b", "x": 0.0, "y": "-t"}]
    data["obstacles"][0]["motion"] = {"y": "t"}
    assert advice(carom.Scenario.from_dict(data), "b", "floor") == (
        "motions.0, obstacles.0.motion drive them into one another, and no contact moves what is "
        "prescribed; change that, or disable the pair in contact.pairs"
    )


@pytest.mark.parametrize("kind", ["dynamic", "static"])
def test_two_blocks_that_motions_drive_into_one_another_are_told_so(tmp_path, kind):
    analysis = {"kind": kind, "end_time": 1.0, "time_step": 0.05}
    scenario = case(analysis=analysis, motions=[HELD, DRIVEN], obstacles=[])
    words = r": motions\.1 drives them into one another, and no contact moves what is prescribed; "
    with warnings.catch_warnings(), pytest.raises(carom.PenetrationError, match=words):
        warnings.simplefilter("ignore", carom.CaromWarning)
        carom.run(scenario, out=tmp_path)
