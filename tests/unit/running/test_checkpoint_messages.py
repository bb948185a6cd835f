"""A checkpoint whose arrays contradict one another is refused, with the array that does."""

import numpy as np
import pytest

from carom._carom import CHECKPOINT_SCHEMA
from carom.building.build import build
from restarting import scenario


@pytest.fixture(scope="module")
def arrays():
    """Two discs just when they touch: there are reactions, an event and factors."""
    simulation = build(scenario())
    while not len((arrays := simulation.checkpoint())["state/reactions/site"]) > 4:
        simulation.advance(simulation.time + 2e-3, 10.0)
    return arrays


def first(value):
    """Replace the first entry."""

    def change(array):
        array[0] = value
        return array

    return change


def more(*counts):
    """Add to the counts."""
    return lambda array: array + np.array(counts, dtype=array.dtype)


BAD = [
    (
        "cross_checks/counts",
        more(0, 0, 1),
        "cross_checks/counts: has more answers than problems",
    ),
    (
        "cross_checks/counts",
        more(1, 0, 1),
        "cross_checks/time_of_max: is missing where answers differ",
    ),
    ("schema", first(99), f"schema: is 99, this version reads {CHECKPOINT_SCHEMA}"),
    ("schema", lambda a: a.astype(np.float32), "schema: neither float64 nor uint64 in one dimens"),
    ("run/stage", first(9), "run/stage: is none of the case"),
    ("run/step", first(10**9), "run/step: is beyond the end of the run"),
    ("run/halvings", first(2**40), "run/halvings: is too large a number"),
    ("state/time", lambda a: np.repeat(a, 2), "state/time: has 2 entries, not 1"),
    ("state/velocity", first(np.nan), "state/velocity: "),
    ("events/pair", first(99), "events/pair: names a pair that is not there"),
    ("events/last", lambda a: a + 99, "events/last: names an event that is not there"),
    ("factors/0/dt", first(0.0), "factors/0/dt: is not positive"),
    ("factors/0/nodes", first(10**6), "factors/0/nodes: names a node that is not there"),
    ("state/reactions/pair", first(99), "state/reactions/pair: names a pair that is not there"),
    ("state/reactions/site", first(10**6), "state/reactions/site: names a node that is not there"),
    (
        "state/reactions/facet",
        lambda a: np.full_like(a, 10**6),
        "state/reactions/facet: names a facet that is not there",
    ),
    (
        "state/reactions/stencil_node",
        first(10**6),
        "state/reactions/stencil_node: names a node that is not there",
    ),
    (
        "state/reactions/stencil_length",
        first(99),
        "state/reactions/stencil_length: does not fit the stencils",
    ),
    ("state/reactions/pair", lambda a: a[::-1].copy(), "state/reactions/site: is not ascending"),
]


@pytest.mark.parametrize(("name", "change", "message"), BAD)
def test_an_array_that_fits_nothing_is_named(arrays, name, change, message):
    spoilt = {key: array.copy() for key, array in arrays.items()}
    spoilt[name] = change(spoilt[name])
    with pytest.raises(ValueError) as caught:
        build(scenario()).restore(spoilt)
    assert str(caught.value).startswith(message)


def test_an_array_that_is_missing_is_named(arrays):
    without = {key: array for key, array in arrays.items() if key != "state/velocity"}
    with pytest.raises(ValueError, match=r"^state/velocity: "):
        build(scenario()).restore(without)
