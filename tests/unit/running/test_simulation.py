"""Running with the native module."""

import numpy as np
import pytest

import carom
from carom import cli
from carom.building.build import build


@pytest.fixture
def bars(examples):
    scenario = carom.Scenario.from_toml(examples / "two_bars.toml")
    return scenario.with_overrides(
        [
            "bodies.0.mesh.divisions=[20, 1]",
            "bodies.1.mesh.divisions=[20, 1]",
            "analysis.time_step=1e-4",
        ]
    )


def test_description_matches_what_was_described(bars):
    simulation = build(bars)
    description = simulation.describe()
    assert description["dofs"] == 2 * 2 * 21 * 2
    assert description["steps"] == simulation.steps == 400
    assert description["energy"] == pytest.approx(0.5 * 2 * 0.01 * 1.0**2)
    assert [body["mass"] for body in description["bodies"]] == pytest.approx([0.01, 0.01])
    assert description["pairs"][0]["initial_gap"] == pytest.approx(0.02)


def test_mesh_and_fields_have_the_shapes_of_the_contract(bars):
    simulation = build(bars)
    mesh, fields = simulation.mesh(), simulation.fields()
    points, cells = 2 * 21 * 2, 2 * 20
    assert mesh["points"].shape == (points, 2)
    assert mesh["offsets"].tolist() == list(range(0, 4 * cells + 1, 4))
    assert mesh["connectivity"].shape == (4 * cells,)
    assert mesh["types"].tolist() == [9] * cells
    assert mesh["body"].tolist() == [0] * 20 + [1] * 20
    assert fields["displacement"].shape == (points, 2)
    assert fields["velocity"].shape == (points, 2)
    assert fields["reaction"].shape == (points, 2)
    assert fields["stress"].shape == (cells, 6)
    assert fields["energy_density"].shape == (cells,)


def test_slices_do_not_change_the_motion(bars):
    whole, sliced = (build(bars) for _ in range(2))
    while not whole.advance(0.02, 60.0):
        pass
    while not sliced.advance(0.02, 0.0):
        pass
    assert sliced.time == whole.time == pytest.approx(0.02)
    for name, values in whole.fields().items():
        np.testing.assert_array_equal(sliced.fields()[name], values)


def test_run_records_the_whole_time(bars, tmp_path):
    steps = []
    result = carom.run(bars, out=tmp_path, progress=lambda progress: steps.append(progress.step))
    assert result.summary["status"] == "completed"
    assert result.summary["steps"] == steps[-1] == 400
    time = result.history["time"]
    assert (time[0], time[-1]) == (0.0, pytest.approx(0.04))
    assert np.all(np.diff(time) > 0)
    np.testing.assert_allclose(
        result.history["total"], result.history["kinetic"] + result.history["strain"]
    )
    (contact,) = result.summary["contacts"]
    assert set(contact["pair"]) == {"left", "right"}
    assert 0.009 < contact["onset"] < contact["release"] < 0.031


def test_bad_geometry_writes_nothing(bars, tmp_path):
    out = tmp_path / "out"
    overlapping = bars.with_overrides(["bodies.1.mesh.corner=[-1.0, 0.0]"])
    with pytest.raises(carom.InputError, match=r"left|right"):
        carom.run(overlapping, out=out)
    assert not out.exists()


def test_check_warns_of_coarse_steps(bars):
    assert carom.check(bars).warnings == ()
    coarse = bars.with_overrides(["analysis.time_step=0.015", "output.history_every=0.02"])
    warnings = carom.check(coarse).warnings
    assert any("suggested" in warning for warning in warnings)
    assert any("whole number" in warning for warning in warnings)


def test_check_says_on_one_line_each_what_is_probably_not_meant(bars, tmp_path, capsys):
    case = tmp_path / "bars.toml"
    case.write_text(bars.to_toml())
    pair = "[{between=['left','right'],enabled=false}]"
    changes = ("analysis.time_step=0.015", "output.history_every=0.02", f"contact.pairs={pair}")
    with pytest.raises(SystemExit):
        cli.app(["check", str(case), *(f"--set={change}" for change in changes)])
    assert "warning: analysis.end_time = " in (said := capsys.readouterr().out)
    assert " s is not a whole number of time steps of 0.015 s\n" in said
    assert "nothing can touch: there is one body and no obstacle, or no pair enabled\n" in said


@pytest.mark.parametrize(("key", "value"), [("velocity", [0.0, -1e7]), ("spin", 1e8)])
def test_a_body_that_would_leap_is_refused(box, key, value):
    box["bodies"][0][key] = value
    with pytest.raises(carom.InputError) as caught:
        build(carom.Scenario.from_dict(box))
    assert caught.value.key == f"bodies.0.{key}"
    assert str(caught.value).startswith(f"bodies.0.{key}: left would move by ")
    box["analysis"] = {"kind": "dynamic", "end_time": 1e-6, "time_step": 1e-9}
    build(carom.Scenario.from_dict(box))
