"""carom's own part of the comparison, and the table."""

import pytest
from compare.codes import carom
from compare.energy import Motion
from compare.outcome import Job, Outcome
from compare.problems import BARS, CYLINDERS
from compare.table import differences, table


@pytest.mark.parametrize("problem", [BARS, CYLINDERS], ids=lambda problem: problem.name)
def test_carom_runs_the_problem_and_the_common_routine_sees_its_energy_kept(
    problem, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    outcome = carom.run(problem.shortened(40), "conserving/midpoint", 0.0)
    assert outcome.dofs == problem.points.size
    assert outcome.steps == 40
    assert outcome.seconds > 0
    assert outcome.motion.excursion < 1e-9
    assert len(outcome.motion.times) == 1 + 40 // problem.sample_every


def outcome(seconds, *, touched=0.1, change=0.0):
    """Return two looks at the cylinders, in which only the first has been touched."""
    velocities = [[[1.0, -2.0], [0.0, 0.0]], [[1.0, 2.0], [0.0, 0.0]]]
    motion = Motion([0.0, touched], [8.0, 8.0 * (1 + change)], velocities)
    return Outcome("1.0", 2084, 600, seconds, motion)


def test_outcome_survives_its_file(tmp_path):
    file = tmp_path / "outcome.json"
    outcome(0.6).write(file)
    assert Outcome.read(file) == outcome(0.6)


def test_table_divides_medians_and_tells_other_physics():
    runs = {
        Job("carom", "cylinders", "theta/gap", 0.0): [outcome(s) for s in (0.6, 9.0, 0.6)],
        Job("carom", "cylinders", "conserving/midpoint", 0.0): [outcome(1.2)],
        Job("kratos", "cylinders", "alm", 0.0): [outcome(60.0, change=-0.001)],
        Job("calculix", "cylinders", "hht", 0.0): [outcome(120.0, touched=0.15)],
        Job("kratos", "cylinders", "alm", 0.2): [],
    }
    rows = [line.strip("| ").split(" | ") for line in table(CYLINDERS, runs).splitlines()[2:]]
    assert [row[5:8] for row in rows[:4]] == [
        ["1", "1", "0.5"],
        ["2", "2", "1"],
        ["100", "100", "50"],
        ["200", "200", "100"],
    ]
    assert rows[4][0] == "LMGC90: measured earlier, not in this run"
    assert rows[2][8:11] == ["-1.0e-03", "1.0e-03", "0.100, never"]
    (line,) = differences(CYLINDERS, runs)
    assert line == "calculix, hht, μ = 0: a body is first touched at 0.15 s, in carom at 0.1 s"
