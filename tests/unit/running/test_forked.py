"""A process that is forked has none of the threads of its parent."""

import multiprocessing
import os
import threading

import numpy as np
import pytest

import carom

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no forks here")


def heap():
    """Discs that threads share: nodes of several bodies."""
    disc = {"kind": "disc", "radius": 0.4, "divisions": 8, "rings": 8}
    bodies = [
        {
            "name": f"disc{k}",
            "material": "rubber",
            "mesh": {**disc, "centre": [k % 4, 0.395 + k // 4]},
        }
        for k in range(12)
    ]
    return carom.Scenario.from_dict(
        {
            "dimension": 2,
            "analysis": {"end_time": 0.01, "time_step": 0.001, "gravity": [0.0, -9.81]},
            "materials": {
                "rubber": {
                    "kind": "saint-venant-kirchhoff",
                    "young": 2700.0,
                    "poisson": 0.33,
                    "density": 1.0,
                }
            },
            "bodies": bodies,
            "obstacles": [
                {"name": "floor", "kind": "plane", "point": [0, -0.01], "normal": [0, 1]}
            ],
            "contact": {"friction": 0.3},
        }
    )


def stepped():
    simulation = carom.Simulation(heap())
    for _ in range(3):
        simulation.step()
    return np.concatenate([body.points for body in simulation.bodies.values()])


@pytest.mark.parametrize("thread", [False, True])
def test_a_forked_process_steps_on_without_its_parents_threads(thread):
    """It waited for them for ever, as did threads that it started itself."""
    here = stepped()
    context = multiprocessing.get_context("fork")
    receives, sends = context.Pipe(duplex=False)

    def child():
        def work():
            sends.send(stepped())

        if thread:
            worker = threading.Thread(target=work)
            worker.start()
            worker.join()
        else:
            work()

    process = context.Process(target=child)
    process.start()
    try:
        assert receives.poll(60.0), "it waits"
        np.testing.assert_array_equal(receives.recv(), here)
    finally:
        process.kill()
        process.join()
