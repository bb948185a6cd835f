"""A process that is forked has none of the threads of its parent."""

import multiprocessing
import os
import sys
import threading
from pathlib import Path

import numpy as np
import pytest

import carom

sys.path.insert(0, str(Path(__file__).parents[3] / "benchmarks"))
from many_bodies import pile

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no forks here")


def stepped():
    # Threads share the nodes of so many discs.
    simulation = carom.Simulation(pile(2, 40))
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
