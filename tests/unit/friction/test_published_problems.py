"""Problems that others published, where the environment variable CAROM_FCLIB names their folder."""

import os
import warnings
from pathlib import Path

import pytest

from carom import friction

FOLDER = os.environ.get("CAROM_FCLIB")
FILES = sorted(p for p in Path(FOLDER or ".").rglob("*") if p.suffix in {".hdf5", ".dat"})


@pytest.mark.skipif(FOLDER is None, reason="CAROM_FCLIB names no folder")
@pytest.mark.parametrize("path", FILES if FOLDER else [None], ids=lambda path: path and path.name)
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
