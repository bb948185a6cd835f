"""What is refused of stages, and what goes on from one to the next."""

import pytest

import carom
import staging


def refused(change, message):
    case = staging.case()
    change(case, *case["stages"])
    with pytest.raises(carom.InputError, match=message):
        carom.Scenario.from_dict(case)


STAGES = {
    "an analysis above stages": (
        lambda case, *_: case.update(analysis={"end_time": 1.0, "time_step": 0.1}),
        "analysis: every stage has its own analysis; leave this one out",
    ),
    "neither analysis nor stages": (
        lambda case, *_: case.update(stages=[]),
        "analysis: required key is missing",
    ),
    "a name twice": (
        lambda case, preload, hit, rest: rest.update(name="hit"),
        'stages.2.name = "hit": name already used by stages.1.name',
    ),
    "an end before the start": (
        lambda case, preload, hit, rest: hit["analysis"].update(end_time=4e-5),
        r"stages.1.analysis.end_time = 4e-05: must be at least one time_step after 1 s, where "
        r"stage 'preload' ends: .* for a duration of 4e-05 s give 1.00004",
    ),
    "a first end within a step": (
        lambda case, preload, hit, rest: preload["analysis"].update(time_step=2.0),
        "stages.0.analysis.end_time = 1.0: must be at least one time_step",
    ),
    "a load removed that is not there": (
        lambda case, preload, hit, rest: rest.update(
            removed_loads=[{"kind": "pressure", "body": "lid", "on": "topp"}]
        ),
        'stages.2.removed_loads.0: there is no such load .* did you mean "pressure lid top"',
    ),
    "a load removed and given": (
        lambda case, preload, hit, rest: hit.update(
            loads=[{"kind": "pressure", "body": "lid", "on": "top", "pressure": 1.0}],
            removed_loads=[{"kind": "pressure", "body": "lid", "on": "top"}],
        ),
        "stages.1.removed_loads.0: the load that this stage gives there takes its place",
    ),
    "a load removed twice": (
        lambda case, preload, hit, rest: (
            hit.update(removed_loads=[{"kind": "pressure", "body": "lid", "on": "top"}]),
            rest.update(removed_loads=[{"kind": "pressure", "body": "lid", "on": "top"}]),
        ),
        "stages.2.removed_loads.0: there is no such load to remove",
    ),
    "a support removed that is not there": (
        lambda case, preload, hit, rest: hit.update(removed_motions=[{"body": "lid", "on": "top"}]),
        "stages.1.removed_motions.0: there is no such motion to remove: known: base bottom",
    ),
    "a load of nobody": (
        lambda case, preload, hit, rest: hit["loads"][0].update(body="lit"),
        'stages.1.loads.0.body = "lit": no such body; did you mean "lid"',
    ),
    "a motion of nobody": (
        lambda case, preload, hit, rest: hit.update(
            motions=[{"kind": "fixed", "body": "lit", "on": "left"}]
        ),
        'stages.1.motions.0.body = "lit": no such body',
    ),
    "a velocity in a static stage": (
        lambda case, preload, hit, rest: rest.update(
            velocities=[{"body": "lid", "velocity": [1, 0]}]
        ),
        "stages.2.velocities: a static stage knows no velocities",
    ),
    "a velocity that says nothing": (
        lambda case, preload, hit, rest: hit.update(velocities=[{"body": "lid"}]),
        "stages.1.velocities.0: give velocity or spin",
    ),
    "a velocity of nobody": (
        lambda case, preload, hit, rest: hit.update(
            velocities=[{"body": "lit", "velocity": [1, 0]}]
        ),
        'stages.1.velocities.0.body = "lit": no such body',
    ),
    "a velocity twice": (
        lambda case, preload, hit, rest: hit.update(
            velocities=[{"body": "lid", "velocity": [1, 0]}] * 2
        ),
        "stages.1.velocities.1.body .*the body has a velocity already in this stage",
    ),
    "a spin of another dimension": (
        lambda case, preload, hit, rest: hit.update(
            velocities=[{"body": "lid", "spin": [0.0, 0.0, 1.0]}]
        ),
        "stages.1.velocities.0.spin .*a spin in 2D is a number",
    ),
    "a velocity of another dimension": (
        lambda case, preload, hit, rest: hit.update(
            velocities=[{"body": "lid", "velocity": [1.0]}]
        ),
        "stages.1.velocities.0.velocity .*must have 2 components, not 1",
    ),
    "a velocity in the first stage": (
        lambda case, preload, hit, rest: (
            case.update(stages=[hit]),
            hit.update(velocities=[{"body": "lid", "velocity": [1, 0]}]),
        ),
        "stages.0.velocities.0: what moves when the case starts is given in bodies.1",
    ),
    "a body that moves when a static stage starts": (
        lambda case, *_: case["bodies"][1].update(velocity=[1, 0]),
        "bodies.1.velocity .*the first stage is static and knows no velocities; give it in",
    ),
    "a condition of a static stage": (
        lambda case, preload, hit, rest: rest.update(contact={"condition": "midpoint"}),
        'stages.2.contact.condition = "midpoint": a static stage rules the gap',
    ),
    "nodes without mass in some stages": (
        lambda case, preload, hit, rest: case["stages"].append(
            {
                "name": "again",
                "analysis": {"end_time": 3.0, "time_step": 0.1},
                "contact": {"condition": "midpoint"},
            }
        ),
        'stages.3.contact.condition = "midpoint": contact nodes have mass in some dynamic stages',
    ),
    "a condition of dynamic stages where there is none": (
        lambda case, preload, hit, rest: (
            case.update(stages=[preload]),
            case["contact"].update(condition="endpoint"),
        ),
        'contact.condition = "endpoint": is of dynamic stages, and there is none',
    ),
    "a contact that changes nothing": (
        lambda case, preload, hit, rest: hit.update(contact={}),
        "stages.1.contact: changes nothing",
    ),
    "an output that says nothing": (
        lambda case, preload, hit, rest: hit.update(output={}),
        "stages.1.output: says nothing",
    ),
    "a pair of one": (
        lambda case, preload, hit, rest: hit.update(
            contact={"pairs": [{"between": ["lid"], "friction": 0.1}]}
        ),
        "stages.1.contact.pairs.0.between .*must be two names",
    ),
    "a pair with nobody": (
        lambda case, preload, hit, rest: hit.update(
            contact={"pairs": [{"between": ["lid", "bace"], "friction": 0.1}]}
        ),
        'stages.1.contact.pairs.0.between = "bace": no such body or obstacle; did you mean "base"',
    ),
    "a pair twice": (
        lambda case, preload, hit, rest: hit.update(
            contact={
                "pairs": [
                    {"between": ["lid", "base"], "friction": 0.1},
                    {"between": ["base", "lid"], "friction": 0.2},
                ]
            }
        ),
        "stages.1.contact.pairs.1.between .*given already in this stage",
    ),
    "a disabled pair": (
        lambda case, preload, hit, rest: (
            case["contact"].update(pairs=[{"between": ["lid", "base"], "enabled": False}]),
            hit.update(contact={"pairs": [{"between": ["base", "lid"], "friction": 0.1}]}),
        ),
        "stages.1.contact.pairs.0.between .*the pair is disabled in contact.pairs",
    ),
    "a body that touches not itself": (
        lambda case, preload, hit, rest: (
            case["bodies"][1].update(self_contact=False),
            hit.update(contact={"pairs": [{"between": ["lid", "lid"], "friction": 0.1}]}),
        ),
        "stages.1.contact.pairs.0.between .*the body has self_contact = false",
    ),
    "a pair of obstacles": (
        lambda case, preload, hit, rest: (
            case.update(
                obstacles=[
                    {"name": name, "kind": "plane", "point": [0, -1], "normal": [0, 1]}
                    for name in ("one", "two")
                ]
            ),
            hit.update(contact={"pairs": [{"between": ["one", "two"], "friction": 0.1}]}),
        ),
        "stages.1.contact.pairs.0.between .*two obstacles never touch",
    ),
    "rows within a step": (
        lambda case, preload, hit, rest: hit.update(output={"history_every": 1e-9}),
        r"stages.1.output.history_every = 1e-09: must be at least one analysis.time_step \(5e-07",
    ),
    "a key that is none": (
        lambda case, preload, hit, rest: hit.update(obstacles=[]),
        "stages.1.obstacles: unknown key",
    ),
}


@pytest.mark.parametrize("what", STAGES)
def test_stages_that_cannot_be_are_refused_with_place_and_remedy(what):
    refused(*STAGES[what])


def test_what_the_core_refuses_of_a_stage_is_named_where_the_case_gives_it():
    def message(change):
        case = staging.case()
        change(case)
        with pytest.raises(carom.InputError) as caught:
            carom.check(carom.Scenario.from_dict(case))
        assert str(caught.value).startswith(f"{caught.value.key}: ")
        return str(caught.value)

    def load(case):
        case["stages"][1]["loads"][0]["on"] = "inside"

    def above(case):
        case["motions"][0]["on"] = "inside"

    def later(case):
        # Finite in the stage that gives it, and in the next no more.
        case["stages"][0]["loads"][0]["pressure"] = "1e7/step(1.00001 - t)"

    def led(case):
        case["stages"][1]["motions"] = [
            {"kind": "prescribed", "body": "lid", "on": "top", "x": "1e-3*t"}
        ]

    assert message(load).startswith("stages.1.loads.0.on: ")
    assert message(above).startswith("motions.0.on: ")
    assert message(later).startswith("stages.0.loads.0.pressure: its value at t = 1.000010")
    assert message(led).startswith("stages.1.motions.0.x: the displacement at t = 1 s is 0.001 m")
    assert "let it grow from 0, as (t - 1)*0.001 does" in message(led)


def test_velocities_that_leap_are_refused_in_their_stage():
    case = staging.case()
    case["stages"][1]["velocities"] = [{"body": "lid", "velocity": [1e7, 0.0]}]
    with pytest.raises(carom.InputError, match=r"stages.1.velocities.0.velocity: lid would move"):
        carom.check(carom.Scenario.from_dict(case))


def test_what_goes_on_is_written_out():
    case = staging.case()
    case["stages"][0]["analysis"]["gravity"] = [0.0, -9.81]
    case["contact"]["pairs"] = [{"between": ["lid", "base"], "friction": 0.2}]
    case["stages"][1]["contact"] = {"friction": 0.4, "condition": "endpoint"}
    case["stages"][2]["contact"] = {"pairs": [{"between": ["base", "lid"], "friction": 0.5}]}
    preload, hit, rest = carom.Scenario.from_dict(case).full_stages()
    assert [stage.analysis.gravity for stage in (preload, hit, rest)] == [(0.0, -9.81)] * 3
    assert [stage.start_time for stage in (preload, hit, rest)] == [0.0, 1.0, 1.00004]
    assert [one.key for one in hit.loads] == ["stages.0.loads.0", "stages.1.loads.0"]
    assert [stage.contact.condition for stage in (preload, hit, rest)] == ["gap", "endpoint", "gap"]
    assert [stage.contact.friction for stage in (preload, hit, rest)] == [0.3, 0.4, 0.4]
    assert [stage.contact.pairs[0].friction for stage in (preload, hit, rest)] == [0.2, 0.2, 0.5]
    # Never less than a step, and else a 1000th of the stage.
    assert [stage.history_every for stage in (preload, hit, rest)] == [0.5, 5e-7, 1.0]
    (whole,) = carom.Scenario.from_dict(
        {**case, "stages": [], "analysis": {"end_time": 2.0, "time_step": 1e-4}}
    ).full_stages()
    assert (whole.name, whole.key, whole.history_every) == ("", "", 2e-3)


def test_stages_survive_toml_and_back(tmp_path):
    case = staging.case()
    case["stages"][1] |= {
        "removed_loads": [{"kind": "pressure", "body": "lid", "on": "top"}],
        "removed_motions": [{"body": "base", "on": "bottom"}],
        "motions": [{"kind": "fixed", "body": "base", "on": "left"}],
        "contact": {"friction": 0.1, "pairs": [{"between": ["lid", "base"], "friction": 0.5}]},
        "velocities": [{"body": "lid", "velocity": [1.0, 0.0], "spin": 2.0}],
        "output": {"fields_every": 1e-6, "history_every": 2e-6},
    }
    scenario = carom.Scenario.from_dict(case)
    for complete in (False, True):
        file = tmp_path / "case.toml"
        file.write_text(scenario.to_toml(complete=complete), encoding="utf-8")
        assert carom.Scenario.from_toml(file) == scenario
    assert scenario.with_overrides(["stages.1.contact.friction=0.1"]) == scenario


def test_overlaps_are_taken_up_by_the_end_of_the_first_stage():
    case = staging.case()
    case["contact"]["resolve_overlap"] = True
    stages = carom.Scenario.from_dict(case).full_stages()
    assert [stage.contact.overlap_resolved_at for stage in stages] == [1.0] * 3
