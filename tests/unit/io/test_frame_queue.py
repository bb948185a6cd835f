"""Frames wait for each other and reach their files together, in order, from another thread."""

import threading

import h5py
import pytest

from carom.io import frame_queue
from carom.io.frame_queue import Frame, FrameQueue
from carom.io.vtkhdf import FieldsWriter
from stand_in import MESH, made_up_fields


class Noting:
    """A writer that notes what it is given, and from which thread."""

    def __init__(self, error=None):
        self.batches = []
        self.threads = set()
        self.error = error

    def append(self, times, frames):
        if self.error is not None:
            raise self.error
        self.batches.append(list(times))
        self.threads.add(threading.current_thread())


def frame(time):
    return Frame(time, made_up_fields(time), {}, None)


@pytest.fixture
def always(monkeypatch):
    monkeypatch.setattr(frame_queue, "PERIOD", -1.0)


def test_frames_wait_until_they_are_many_or_asked_for(monkeypatch):
    fields, surface = Noting(), Noting()
    queue = FrameQueue(fields, surface, None)
    for time in (0.0, 0.1, 0.2):
        queue.put(frame(time))
    assert fields.batches == []
    monkeypatch.setattr(frame_queue, "ROOM", 1)
    queue.put(frame(0.3))
    queue.put(frame(0.4))
    queue.close()
    assert fields.batches == surface.batches == [[0.0, 0.1, 0.2, 0.3], [0.4]]
    assert threading.current_thread() not in fields.threads


def test_frames_do_not_wait_longer_than_the_period(always):
    fields = Noting()
    queue = FrameQueue(fields, Noting(), None)
    queue.put(frame(0.0))
    queue.flush()
    queue.write_due()
    assert fields.batches == [[0.0]]
    queue.close()


@pytest.mark.parametrize("error", [OSError("no room"), RuntimeError("no room in HDF5")])
def test_frames_behind_one_that_could_not_be_written_are_given_up(always, error):
    fields = Noting(error=error)
    queue = FrameQueue(fields, Noting(), None)
    queue.put(frame(0.0))
    with pytest.raises(type(error), match="no room"):
        queue.put(frame(0.1))
    fields.error = None
    queue.close()
    assert fields.batches == []


def test_one_batch_or_many_make_the_same_arrays(tmp_path):
    times = [0.0, 0.1, 0.25]
    for name, batches in (("one", [times]), ("many", [[time] for time in times])):
        writer = FieldsWriter(tmp_path / name, MESH)
        for batch in batches:
            writer.append(batch, [made_up_fields(time) for time in batch])

    def compare(name, entry):
        if isinstance(entry, h5py.Dataset):
            assert (entry[()] == many[name][()]).all(), name

    with h5py.File(tmp_path / "one") as one, h5py.File(tmp_path / "many") as many:
        one.visititems(compare)
        assert one["VTKHDF/Steps"].attrs["NSteps"] == many["VTKHDF/Steps"].attrs["NSteps"] == 3
