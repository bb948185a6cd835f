import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from carom.report.codec import pack, pack_quantised, unpack


@pytest.mark.parametrize(
    ("kind", "values"),
    [
        ("u4", np.array([[0, 1, 2**31], [7, 2**32 - 1, 5]])),
        ("f8", np.array([1.0, -0.1, np.nan, np.inf, 1e-300])),
        ("f4", np.array([[0.5], [-3.0]])),
        ("u4", np.empty((0, 2))),
    ],
)
def test_what_is_packed_as_it_is_comes_back(kind, values):
    packed = json.loads(json.dumps(pack(values, kind)))
    np.testing.assert_array_equal(unpack(packed), values.astype(kind))


@settings(max_examples=60)
@given(
    arrays.arrays(
        np.float64,
        st.tuples(st.integers(1, 4), st.integers(1, 5), st.integers(1, 3)),
        elements=st.floats(-1e12, 1e12),
    )
)
def test_quantised_values_come_back_to_within_half_a_step(values):
    back = unpack(json.loads(json.dumps(pack_quantised(values))))
    span = np.ptp(values, axis=(0, 1))
    size = np.abs(values).max(axis=(0, 1))
    subnormal = np.finfo(float).smallest_normal  # numbers below it have fewer digits
    assert (np.abs(back - values) <= span / 65534 / 2 * (1 + 1e-9) + 1e-12 * size + subnormal).all()


def test_what_is_not_finite_stays_out_of_the_range():
    values = np.array([[[1.0], [np.nan]], [[np.inf], [3.0]]])
    back = unpack(pack_quantised(values))
    np.testing.assert_allclose(back, [[[1.0], [np.nan]], [[np.nan], [3.0]]])


def test_what_moves_little_from_frame_to_frame_takes_little_room():
    points = np.random.default_rng(1).uniform(size=(1, 500, 2))
    still = np.repeat(points, 40, axis=0)
    assert len(pack_quantised(still)["data"]) < 1.2 * len(pack_quantised(points)["data"])
