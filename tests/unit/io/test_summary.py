import json

import pytest

from carom.io.summary import write_summary


def test_what_is_not_finite_becomes_null(tmp_path):
    path = tmp_path / "summary.json"
    write_summary(path, {"min_gap": float("inf"), "contacts": [{"release": float("nan")}]})
    assert json.loads(path.read_text()) == {"min_gap": None, "contacts": [{"release": None}]}


def test_a_summary_that_cannot_be_written_leaves_the_old_one(tmp_path):
    path = tmp_path / "summary.json"
    write_summary(path, {"status": "completed"})
    with pytest.raises(TypeError):
        write_summary(path, {"status": object()})
    assert json.loads(path.read_text()) == {"status": "completed"}
    assert [file.name for file in tmp_path.iterdir()] == ["summary.json"]
