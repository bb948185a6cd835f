"""Springs have no state of their own: a run that stopped goes on with them to the last bit."""

import pytest

import carom
import restarting
from carom import Observer, Stop

SQUARE = {"kind": "rectangle", "size": [1.0, 1.0], "divisions": [3, 3]}


def swinging(scheme):
    """A soft block on a belt, a rigid one that hangs from it, and stages."""
    return carom.Scenario.from_dict(
        {
            "title": "Swing",
            "analysis": {
                "end_time": 0.4,
                "time_step": 4e-3,
                "gravity": [0, -9.81],
                "scheme": {"kind": scheme},
            },
            "output": {"history_every": 8e-3, "fields_every": 0.1, "checkpoint_every": 4e-2},
            "materials": {
                "soft": {"kind": "neo-hookean", "young": 5e3, "poisson": 0.3, "density": 1.0}
            },
            "bodies": [
                {"name": "soft", "material": "soft", "mesh": {**SQUARE, "corner": [0.0, 0.01]}},
                {
                    "kind": "rigid",
                    "name": "hard",
                    "mass": 0.5,
                    "mesh": {**SQUARE, "corner": [2.0, 1.5]},
                    "spin": 1.0,
                },
            ],
            "masses": [{"body": "soft", "on": "top", "mass": 0.5}],
            "springs": [
                {
                    "name": "rope",
                    "between": [{"body": "soft", "on": "right"}, {"body": "hard", "point": [2, 2]}],
                    "force": {"elongation": [-1, 0, 1], "force": [0, 0, 80]},
                    "damping": 0.2,
                },
                {
                    "name": "strut",
                    "between": [{"body": "hard", "point": [2.6, 2.1]}, {"point": [3.0, 5.0]}],
                    "stiffness": 20.0,
                },
            ],
            "obstacles": [
                {
                    "kind": "plane",
                    "name": "floor",
                    "point": [0, 0],
                    "normal": [0, 1],
                    "velocity": [0.5, 0.0],
                }
            ],
            "contact": {"friction": 0.3},
        }
    )


@pytest.mark.parametrize("scheme", ["conserving", "theta"])
def test_a_stopped_run_with_springs_goes_on_to_the_last_bit(tmp_path, scheme):
    whole = carom.run(swinging(scheme), out=tmp_path / "whole")
    assert whole.summary["status"] == "completed"
    assert whole.summary["energy"]["dampers"] > 0.0

    def stop(state):
        if state.time > 0.21:
            raise Stop

    observers = [Observer(stop, every=0.02)]
    stopped = carom.run(swinging(scheme), out=tmp_path / "parts", observers=observers)
    assert stopped.summary["status"] != "completed"
    end = carom.run(swinging(scheme), out=tmp_path / "parts", resume=True)
    assert end.summary["status"] == "completed"
    restarting.assert_same_results(tmp_path / "parts", tmp_path / "whole")


def test_springs_without_stored_steps_are_audited(tmp_path):
    carom.run(swinging("conserving"), out=tmp_path / "run")
    assert carom.audit(tmp_path / "run").refuted == ()
