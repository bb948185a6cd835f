"""What the page draws is what the run has stored."""

import numpy as np
import pytest

from carom.io.frames import Frames
from carom.report.codec import unpack
from carom.report.fields import bodies
from carom.view import shown


@pytest.fixture(params=["disc", "ball"])
def result(request):
    return request.getfixturevalue(request.param)


def allowed(packed):
    """Half a step, and the rounding of the single precision that values pass through."""
    low, step = np.array(packed["low"]), np.array(packed["step"])
    return step / 2 + 2e-7 * np.maximum(np.abs(low), np.abs(low + 65534 * step))


def test_displacements_and_reactions_are_those_of_the_file(result, data_of):
    scene = data_of(result.path / "report.html").scene
    frames = Frames(result.fields_path)
    dimension = scene["dimension"]
    points = unpack(scene["points"])
    np.testing.assert_array_equal(unpack(scene["times"]), frames.times)
    # The points of the page by where they are in the file.
    distance = np.linalg.norm(points[:, None] - frames.points[None, :, :dimension], axis=2)
    of_file = distance.argmin(axis=1)
    assert distance.min(axis=1).max() < 1e-6
    for name in ("displacement", "reaction"):
        packed = scene["arrays"][name]
        values = unpack(packed)
        for frame in range(len(frames.times)):
            stored = frames.field(name, frame)[of_file, :dimension]
            assert (np.abs(values[frame] - stored) <= allowed(packed)).all()


def test_every_field_has_the_values_of_the_file(result, data_of):
    scene = data_of(result.path / "report.html").scene
    frames, surface = Frames(result.fields_path), Frames(result.surface_path)
    keys = {field["key"]: field for field in scene["fields"]}
    assert {"von-mises", "displacement", "velocity", "energy_density", "pressure"} <= set(keys)
    for key in keys:
        if key in ("displacement", "reaction"):
            continue
        packed = scene["arrays"][key]
        values = unpack(packed)
        file = (
            frames
            if key in frames.names or key in ("von-mises", "hydrostatic-pressure")
            else surface
        )
        for frame in range(len(frames.times)):
            stored = shown(file, key).values(file, frame)
            # Each value is one of the file's, and in the plane none is missing.
            near = np.abs(values[frame] - stored[None, :]).min(axis=1)
            assert near.max() <= allowed(packed)[0]
            if scene["dimension"] == 2:
                assert values[frame].sum() == pytest.approx(
                    stored.sum(), abs=len(stored) * allowed(packed)[0]
                )


def test_frames_are_thinned_evenly_to_the_budget(disc):
    frames, surface = Frames(disc.fields_path), Frames(disc.surface_path)
    whole = bodies(frames, surface)
    assert len(whole.frames) == whole.recorded == 21
    total = sum(len(array["data"]) for array in whole.data["arrays"].values())
    half = bodies(frames, surface, budget=total // 2)
    assert 2 < len(half.frames) < 21
    assert half.frames[0] == 0 and half.frames[-1] == 20
    assert np.ptp(np.diff(half.frames)) <= 1
    assert sum(len(array["data"]) for array in half.data["arrays"].values()) <= total // 2
    assert len(bodies(frames, surface, budget=1).frames) == 2
