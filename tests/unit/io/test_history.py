import numpy as np
import pytest

from carom import InputError
from carom.io.history import HistoryWriter, read_history


def test_floats_read_back_exactly(tmp_path):
    rows = np.array([[0.1 + 0.2, 1e-300, 1 / 3], [np.pi, -0.0, 1e22], [np.nan, np.inf, 2.0**-1074]])
    path = tmp_path / "history.csv"
    writer = HistoryWriter(path, ["time", "a,b", "left.x"])
    writer.append(rows[:1])
    writer.append(rows[:0])
    writer.append(rows[1:])
    history = read_history(path)
    assert list(history) == ["time", "a,b", "left.x"]
    np.testing.assert_array_equal(np.column_stack(list(history.values())), rows)


def test_rows_are_on_disk_at_once(tmp_path):
    writer = HistoryWriter(tmp_path / "history.csv", ["time"])
    assert len(read_history(tmp_path / "history.csv")["time"]) == 0
    writer.append(np.array([[1.0]]))
    assert read_history(tmp_path / "history.csv")["time"].tolist() == [1.0]


def test_an_unfinished_last_line_is_passed_over(tmp_path):
    path = tmp_path / "history.csv"
    path.write_text("time,total\n0.0,1.0\n0.5,0.9")
    assert read_history(path)["total"].tolist() == [1.0]


@pytest.mark.parametrize("text", ["", "time,total\n0.0\n", "\x00\x01\n"])
def test_what_is_no_history_is_refused(tmp_path, text):
    path = tmp_path / "history.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=r"history\.csv: not a history"):
        read_history(path)
