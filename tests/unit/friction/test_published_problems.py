"""Problems that others published: a few beside this file, and more where the environment variable
CAROM_FCLIB names their folder."""

import os
import warnings
from pathlib import Path

import pytest

from carom import friction

HERE = Path(__file__).parent / "published"
FOLDERS = [HERE, *(Path(folder) for folder in [os.environ.get("CAROM_FCLIB")] if folder)]
FILES = sorted(p for f in FOLDERS for p in f.rglob("*") if p.suffix in {".hdf5", ".dat"})


def test_published_problems_are_here_with_their_notice():
    named = {path.name for path in HERE.iterdir()} - {"NOTICE.md"}
    assert len(named) == 6
    notice = (HERE / "NOTICE.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in notice for name in named)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_published_problem_is_solved_and_survives_a_round_trip(path, tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", friction.AsymmetryWarning)
        problem = friction.read(path)
    found = friction.solve(problem, time_limit=30.0)
    assert found.solved, found
    assert problem.measure(found.reactions).decisive <= 1.001e-8
    friction.write(problem, tmp_path / "copy.hdf5", solution=found)
    copy = friction.read_record(tmp_path / "copy.hdf5")
    assert copy.problem.measure(copy.solution.reactions).decisive <= 1.001e-8
