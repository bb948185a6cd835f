"""Half a body, held across its plane of symmetry, moves as the whole does, where it touches too."""

import numpy as np
import pytest

import carom

COLUMNS = ("kinetic", "strain", "friction", "normal_force")


def drop(dimension, *, planes, condition="midpoint"):
    """Drop a block onto a floor; of planes across x and y that are given, the part beyond."""
    across = range(dimension - 1)
    shape = carom.Rectangle if dimension == 2 else carom.Box
    mesh = shape(
        corner=[*(0.0 if k in planes else -1.0 for k in across), 0.01],
        size=[*(1.0 if k in planes else 2.0 for k in across), 1.0],
        divisions=[*(4 if k in planes else 8 for k in across), 3],
    )
    # The plane of symmetry is inside the body.
    outside = ["right", "back", "bottom", "top"] if dimension == 3 else ["right", "bottom", "top"]
    sides = ["left", "front"]
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=0.08,
            time_step=1e-3,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-12),
        ),
        output=carom.Output(history_every=1e-3, fields_every=0.08),
        materials={"rubber": carom.NeoHookean(young=2e4, poisson=0.3, density=10.0)},
        bodies=[
            carom.Body(
                name="block",
                material="rubber",
                mesh=mesh,
                velocity=[0.0 for _ in across] + [-1.0],
                contact_sets=outside if planes else None,
            )
        ],
        motions=[carom.Fixed(body="block", on=sides[k], components=["xy"[k]]) for k in planes],
        obstacles=[
            carom.Plane(name="floor", point=[0.0] * dimension, normal=[0.0 for _ in across] + [1.0])
        ],
        contact=carom.Contact(condition=condition, friction=0.2),
    )


@pytest.mark.parametrize("condition", ["midpoint", "gap"])
def test_half_a_block_in_the_plane_is_half_of_the_whole(tmp_path, condition):
    whole = carom.run(drop(2, planes=[], condition=condition), out=tmp_path / "whole")
    half = carom.run(drop(2, planes=[0], condition=condition), out=tmp_path / "half")
    for column in COLUMNS:
        size = np.abs(whole.history[column]).max()
        assert size > 0.0
        off = np.abs(2.0 * half.history[column] - whole.history[column]).max()
        assert off < 1e-9 * size, column
    way = np.ptp(whole.history["block.y"])
    assert np.abs(half.history["block.y"] - whole.history["block.y"]).max() < 1e-10 * way


def test_a_quarter_of_a_block_in_space_is_a_quarter_of_the_whole(tmp_path):
    whole = carom.run(drop(3, planes=[]), out=tmp_path / "whole")
    quarter = carom.run(drop(3, planes=[0, 1]), out=tmp_path / "quarter")
    for column in COLUMNS:
        size = np.abs(whole.history[column]).max()
        off = np.abs(4.0 * quarter.history[column] - whole.history[column]).max()
        assert off < 1e-9 * size, column
