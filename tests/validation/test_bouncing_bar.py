"""A bar falls on a floor and bounces: books, gaps and heights of the exact solution."""

import bouncing_bar
import numpy as np
import pytest
from runs import observed_order

CELLS = (25, 50, 100)


@pytest.fixture(scope="module")
def bounced():
    return {cells: bouncing_bar.run(cells) for cells in CELLS}


def test_a_string_of_masses_bounces_to_the_exact_height():
    """Leapfrog at c Δt = h is exact but for the step in which contact ends: of first order."""
    errors = []
    for cells in (300, 600):
        size = bouncing_bar.LENGTH / cells
        step = size / bouncing_bar.WAVE_SPEED
        fall = bouncing_bar.GRAVITY * step**2
        before = np.full(cells + 1, bouncing_bar.DROP - 0.5 * fall)
        now = np.full(cells + 1, bouncing_bar.DROP)
        heights = [now[0]]
        for _ in range(round(10.0 / step)):
            mirrored = np.concatenate(([now[1]], now, [now[-2]]))
            after = mirrored[2:] + mirrored[:-2] - before - fall
            # Round-off does not end a contact early: the weight presses with far more.
            after[0] = 0.0 if after[0] < 1e-9 * bouncing_bar.DROP else after[0]
            before, now = now, after
            heights.append(now[0])
        exact = bouncing_bar.exact_height(step * np.arange(len(heights)))
        errors.append(abs(np.array(heights) - exact).max())
    coarse, fine = errors
    assert fine < 0.03 * bouncing_bar.DROP
    assert coarse / fine == pytest.approx(2.0, rel=0.01)


def test_books_close_and_nothing_sinks_in_through_bounces(bounced):
    for run in bounced.values():
        assert run.summary["energy"]["max_defect"] < 1e-13 * bouncing_bar.FALL
        assert run.summary["min_gap"] > -1e-12 * bouncing_bar.LENGTH
        # Without vibration, with all of it, and without it again.
        assert len(run.summary["contacts"]) == 3


def test_heights_converge_to_those_of_the_exact_solution(bounced):
    times = (0.0, bouncing_bar.AFTER, bouncing_bar.FIRST_BOUNCES)
    first, all_three = np.array([bouncing_bar.errors(run, times) for run in bounced.values()]).T
    sizes = [bouncing_bar.LENGTH / cells for cells in CELLS]
    assert observed_order(sizes, list(first)) > 0.85
    assert observed_order(sizes, list(all_three)) > 0.85
    assert first[-1] < 5e-3
    assert all_three[-1] < 1.2e-2
