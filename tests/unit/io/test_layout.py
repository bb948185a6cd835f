import pytest

from carom import InputError
from carom.io import layout


def test_results_of_an_earlier_run_are_removed(tmp_path):
    for name in (layout.SUMMARY, layout.HISTORY, layout.FIELDS, layout.track_plot("tip")):
        (tmp_path / name).touch()
    (tmp_path / "notes.txt").touch()
    layout.clear(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]


def test_files_of_others_are_not_overwritten(tmp_path):
    for name in (layout.CASE, layout.track_plot("record")):
        (tmp_path / name).touch()
    with pytest.raises(InputError, match=r"case\.toml that is not of a carom run; choose another"):
        layout.clear(tmp_path)
    assert len(list(tmp_path.iterdir())) == 2
