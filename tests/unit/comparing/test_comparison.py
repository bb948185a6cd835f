import numpy as np
import pytest
from matplotlib.figure import Figure
from typer.testing import CliRunner

import carom
import restarting
from carom.cli import app
from carom.comparing.case import changes
from carom.comparing.figure import comparison_figure


@pytest.fixture(scope="module")
def other(tmp_path_factory):
    """The discs of `impact` with more friction, at steps of half the length, for half as long."""
    case = restarting.scenario()
    overrides = [
        "contact.friction=0.7",
        f"analysis.time_step={case.analysis.time_step / 2}",
        f"analysis.end_time={case.analysis.end_time / 2}",
    ]
    return carom.run(case.with_overrides(overrides), out=tmp_path_factory.mktemp("other"))


def test_a_run_is_no_different_from_itself(impact):
    both = carom.compare(impact, impact.path)
    assert both.case == ()
    assert all(change.first == change.second for change in both.outcome)
    assert {apart.largest for apart in both.history} == {0.0}


def test_only_what_differs_in_the_cases_is_told(impact, other):
    both = carom.compare(impact, other)
    keys = {change.key: (change.first, change.second) for change in both.case}
    assert set(keys) == {"contact.friction", "analysis.time_step", "analysis.end_time"}
    assert keys["contact.friction"][1] == 0.7


def test_bodies_are_compared_by_name(box):
    """Symptom guarded against: one body more was a difference of all after it."""
    more = {**box, "bodies": [{**box["bodies"][0], "name": "new"}, *box["bodies"]]}
    more["bodies"][0]["mesh"] = {**more["bodies"][0]["mesh"], "centre": [4.0, 7.0]}
    first, second = (carom.Scenario.from_dict(case) for case in (box, more))
    found = changes(first, second)
    assert found
    assert all(change.key.startswith("bodies.new.") for change in found)
    assert all(change.first is None for change in found)


def test_curves_are_compared_as_far_as_both_reach(impact, other):
    both = carom.compare(impact, other)
    assert both.times[-1] <= other.history["time"][-1] * (1 + 1e-9)
    apart = {one.column: one for one in both.history}
    first, second = both.over_time("friction")
    at = np.abs(second - first).argmax()
    assert apart["friction"].largest == second[at] - first[at]
    assert apart["friction"].time == both.times[at]
    # Energies by the largest energy: what round-off leaves of a defect is no difference.
    assert apart["defect"].share < 1e-9
    energies = [np.abs(one).max() for c in ("total", "kinetic") for one in both.over_time(c)]
    assert apart["friction"].share == pytest.approx(
        abs(apart["friction"].largest) / max(energies), rel=1e-12
    )


def test_a_column_that_one_has_not_is_refused(impact, other):
    with pytest.raises(carom.InputError, match="is no column of both histories; these are"):
        carom.compare(impact, other).over_time("nothing")


def test_the_picture_has_both_runs_in_every_diagram(impact, other):
    picture = comparison_figure(carom.compare(impact, other), ["kinetic", "normal_force"])
    assert isinstance(picture, Figure)
    assert [len(axes.lines) for axes in picture.axes] == [2, 2]
    for axes, column in zip(picture.axes, ("kinetic", "normal_force"), strict=True):
        assert np.array_equal(axes.lines[1].get_ydata(), other.history[column])


def test_the_command_tells_and_draws_and_judges(impact, other, tmp_path):
    picture = tmp_path / "both.png"
    runner = CliRunner()
    paths = [str(impact.path), str(other.path)]
    same = runner.invoke(app, ["compare", paths[0], paths[0], "--tolerance", "0"])
    assert same.exit_code == 0
    assert "The cases are the same." in same.output
    assert "the same to the last digit" in same.output
    command = ["compare", *paths, "--out", str(picture), "--columns", "friction,kinetic"]
    told = runner.invoke(app, command)
    assert told.exit_code == 0
    assert "contact.friction" in told.output
    assert picture.stat().st_size > 0
    judged = runner.invoke(app, ["compare", *paths, "--tolerance", "1e-6"])
    assert judged.exit_code == 1
    assert "farther apart than 1e-06" in judged.output
    again = runner.invoke(app, command)
    assert again.exit_code == 2
    assert "--force" in again.output
