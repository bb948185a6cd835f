"""Guided motions of rigid bodies are audited."""

import pytest
from held import SQUARE, held
from refuting import confirmed, refuted_after

import carom
from tampered import in_h5, with_another_case, with_another_number

UNEVEN = {"kind": "theta", "theta": 0.7, "xi": 0.6}

WHEEL = {
    "name": "ball",
    "kind": "rigid",
    "density": 10.0,
    "mesh": {"kind": "disc", "centre": [0.3, 0.71], "radius": 0.2, "divisions": 4},
}

GUIDES = {
    "wheel": {"x": "0.3*t", "y": "-0.02*sin(20*t)", "turn_z": "6*t^2"},
    "platen": {"x": {"time": [0.0, 0.1, 0.2], "value": [0.0, 0.02, 0.0]}, "turn_z": 0.0},
    "slider": {"y": "-0.05*t"},
    "turned": {"turn_z": "0.3*sin(15*t)"},
}


def guided(guide, condition="midpoint", scheme="conserving", **changes):
    """A block on its bottom that a guided wheel is pressed on."""
    given = {
        "bodies": [
            {"name": "beam", "material": "m", "mesh": {**SQUARE, "corner": [0.0, 0.0]}},
            WHEEL,
        ],
        "output": {"history_every": 2e-3, "fields_every": 0.04, "audit": True},
        "motions": [
            {"kind": "fixed", "body": "beam", "on": "bottom"},
            {"kind": "guided", "body": "ball", **GUIDES[guide]},
        ],
        "springs": [
            {
                "name": "stay",
                "between": [{"point": [0.3, 2.0]}, {"body": "ball", "point": [0.35, 0.8]}],
                "stiffness": 30.0,
            }
        ],
    }
    return held(condition, scheme, **{**given, **changes})


@pytest.mark.parametrize("guide", GUIDES)
@pytest.mark.parametrize(
    "method",
    [
        ("gap", "theta"),
        ("midpoint", "conserving"),
        ("endpoint", UNEVEN),
        ("massless", "theta"),
        ("massless", "conserving"),
    ],
    ids=lambda method: method[0] + str(len(str(method[1]))),
)
def test_guided_bodies_are_confirmed(tmp_path, guide, method):
    if (guide, *method) == ("wheel", "massless", "conserving"):
        pytest.skip("the wheel folds corners that have no mass")
    result = carom.run(guided(guide, *method), out=tmp_path)
    assert result.history["contacts"].max() > 0
    assert abs(result.summary["energy"]["prescribed"]) > 1e-4
    checks = confirmed(tmp_path)
    assert checks["support forces"].count == 32


def test_guides_in_load_steps_are_confirmed(tmp_path):
    analysis = {"kind": "static", "end_time": 1.0, "time_step": 0.1}
    platen = {"x": "0.01*t", "y": "-0.05*t", "turn_z": "0.05*t"}
    changes = {
        "analysis": analysis,
        "output": {"history_every": 0.1, "fields_every": 0.1, "audit": True},
    }
    given = guided("platen").model_dump(mode="json")["motions"][:1]
    changes["motions"] = [*given, {"kind": "guided", "body": "ball", **platen}]
    result = carom.run(guided("platen", "gap", "theta", **changes), out=tmp_path)
    assert result.history["normal_force"][-1] > 1.0
    checks = confirmed(tmp_path)
    assert checks["support forces"].count == 40


def test_guides_in_space_are_confirmed(tmp_path):
    box = {"kind": "box", "corner": [0, 0, 0], "size": [1, 1, 0.5], "divisions": [3, 3, 2]}
    cube = {"kind": "box", "corner": [0.3, 0.3, 0.51], "size": [0.4, 0.5, 0.3]}
    cube["divisions"] = [1, 2, 1]
    changes = {
        "dimension": 3,
        "bodies": [
            {"name": "beam", "material": "m", "mesh": box},
            {"name": "ball", "kind": "rigid", "density": 10.0, "mesh": cube},
        ],
        "springs": [],
    }
    analysis = {"end_time": 0.04, "time_step": 2e-3, "gravity": [0, 0, -9.81]}
    analysis["scheme"] = {"kind": "conserving"}
    bottom = {"kind": "fixed", "body": "beam", "on": "bottom"}
    for number, guide in enumerate(
        ({"z": "-0.5*t", "turn_x": "3*t"}, {"x": 0.0, "turn_x": "2*t", "turn_y": 0, "turn_z": "t"})
    ):
        motions = [bottom, {"kind": "guided", "body": "ball", **guide}]
        out = tmp_path / str(number)
        case = held("midpoint", "conserving", **changes, analysis=analysis, motions=motions)
        carom.run(case, out=out)
        confirmed(out)


def test_guides_of_stages_go_on_from_where_they_began(tmp_path):
    case = guided("wheel").model_dump(mode="json", exclude_none=True, exclude_unset=True)
    analysis, case["output"] = case.pop("analysis"), {"audit": True}
    step = {"output": {"history_every": 2e-3, "fields_every": 0.01}}
    later = {"kind": "guided", "body": "ball", "x": "0.1*(t - 0.1)", "turn_z": "3*(t - 0.1)"}
    case["stages"] = [
        {"name": "press", "analysis": {**analysis, "end_time": 0.1}, **step},
        {"name": "turn", "analysis": {**analysis, "end_time": 0.2}, **step, "motions": [later]},
    ]
    carom.run(carom.Scenario.from_dict(case), out=tmp_path)
    confirmed(tmp_path)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("guided")
    carom.run(guided("wheel"), out=out)
    return out


@pytest.mark.parametrize(
    ("old", "new"),
    [("0.3*t", "0.3000001*t"), ("6*t^2", "6.0001*t^2"), ("0.02*sin", "0.0200001*sin")],
)
def test_a_guide_that_is_not_that_of_the_run_is_found(tmp_path, run, old, new):
    directory = with_another_case(run, tmp_path / "changed", old, new)
    assert "supports" in {check.name for check in carom.audit(directory).refuted}


def test_what_a_guide_bears_and_does_is_checked(tmp_path, run):
    changed = with_another_number(run, tmp_path / "changed", "ball.force_y", 1 + 1e-5, row=41)
    assert "support forces" in {check.name for check in carom.audit(changed).refuted}
    tamper = in_h5("audit.h5:steps/000005/ledger@prescribed", lambda work: 1.00001 * work)
    assert "ledger: prescribed" in refuted_after(run, tmp_path, tamper)
