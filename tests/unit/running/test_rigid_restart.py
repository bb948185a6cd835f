"""Rigid bodies are where their nodes are: a run that stopped goes on with them."""

import pytest

import carom
import restarting
from carom import Observer, Stop

BOX = {"kind": "box", "corner": [0.1, 0.2, 0.05], "size": [0.4, 0.3, 0.2], "divisions": [1, 1, 1]}


def tumbling(condition):
    """A box that falls onto a floor, turning, and a plate beside it that is guided and pushed."""
    return carom.Scenario.from_dict(
        {
            "title": "Tumble",
            "dimension": 3,
            "analysis": {"end_time": 0.2, "time_step": 2e-3, "gravity": [0, 0, -9.81]},
            "output": {"history_every": 4e-3, "fields_every": 5e-2, "checkpoint_every": 2e-2},
            "bodies": [
                {
                    "kind": "rigid",
                    "name": "box",
                    "density": 100.0,
                    "mesh": BOX,
                    "velocity": [0.5, 0.0, -1.0],
                    "spin": [3.0, 1.0, 2.0],
                },
                {
                    "kind": "rigid",
                    "name": "plate",
                    "mass": 2.0,
                    "mesh": {**BOX, "corner": [1.2, 0.2, 0.05]},
                },
            ],
            "motions": [{"kind": "guided", "body": "plate", "x": "0.1*t", "turn_z": "2*t"}],
            "loads": [{"kind": "resultant", "body": "plate", "force": [0, 0, "25*t"]}],
            "obstacles": [
                {"kind": "plane", "name": "floor", "point": [0] * 3, "normal": [0, 0, 1]}
            ],
            "contact": {"condition": condition, "friction": 0.3},
        }
    )


@pytest.mark.parametrize("condition", ["midpoint", "endpoint"])
def test_a_stopped_run_of_rigid_bodies_goes_on_to_the_last_bit(tmp_path, condition):
    whole = carom.run(tumbling(condition), out=tmp_path / "whole")
    assert whole.summary["contacts"]

    def stop(state):
        if state.time > 0.11:
            raise Stop

    stopped = carom.run(
        tumbling(condition), out=tmp_path / "parts", observers=[Observer(stop, every=0.01)]
    )
    assert stopped.summary["status"] != "completed"
    end = carom.run(tumbling(condition), out=tmp_path / "parts", resume=True)
    assert end.summary["status"] == "completed"
    restarting.assert_same_results(tmp_path / "parts", whole.path)
