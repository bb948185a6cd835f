"""`output.modes`: what a run writes of the energy of modes, refuses, and says of what has none."""

import numpy as np
import pytest
from scipy.sparse.linalg import ArpackError
from typer.testing import CliRunner

import carom
import staging
from carom.cli import app
from carom.io import layout
from carom.modes import split as splitting
from carom.modes.table import modes_csv, read_modes

SOFT = {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.3, "density": 1.0}
METAL = {**SOFT, "kind": "j2-plasticity", "yield_stress": 1e3}
BLOCK = {"kind": "rectangle", "corner": [0.0, 0.01], "size": [1.0, 1.0], "divisions": [3, 3]}
AWAY = {**BLOCK, "corner": [5.0, 0.01]}


def table(*others, output=None, **given):
    block = {"name": "block", "material": "soft", "mesh": BLOCK, "velocity": [0.0, -1.0]}
    return {
        "title": "modes",
        "analysis": {"end_time": 0.1, "time_step": 5e-3},
        "output": {"fields_every": 0.02, "modes": 6, **(output or {})},
        "materials": {"soft": SOFT, "metal": METAL},
        "bodies": [{**block, **given}, *others],
        "obstacles": [
            {"kind": "plane", "name": "floor", "point": [0.0, 0.0], "normal": [0.0, 1.0]}
        ],
    }


def run(data, directory, **options):
    return carom.run(carom.Scenario.from_dict(data), out=directory, **options)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return run(table(), tmp_path_factory.mktemp("modes") / "run")


def test_the_run_writes_what_carom_modes_finds(results):
    written = read_modes(results.path / layout.MODES)
    found = carom.modal_energies(results, count=6)
    assert written.keys() == found.keys() == {"block"}
    assert modes_csv(found.values()) == (results.path / layout.MODES).read_text()
    for name in ("times", "frequencies", "rigid", "kinetic", "strain", "rest_kinetic"):
        assert np.array_equal(getattr(written["block"], name), getattr(found["block"], name))
    assert np.array_equal(written["block"].total, found["block"].total)
    assert written["block"].total[-1] == pytest.approx(results.summary["energy"]["final"])


def test_a_run_without_it_writes_none(tmp_path):
    result = run(table(output={"modes": None}), tmp_path / "run")
    assert not (result.path / layout.MODES).exists()


def test_a_run_in_its_place_removes_it(tmp_path):
    run(table(), tmp_path / "run")
    assert (tmp_path / "run" / layout.MODES).exists()
    run(table(output={"modes": None}), tmp_path / "run", force=True)
    assert not (tmp_path / "run" / layout.MODES).exists()


@pytest.mark.parametrize(
    ("given", "reason"),
    [
        ({"material": "metal"}, "no body has modes (block: its material flows); leave it out"),
        ({"growth": "1e-3*t"}, "block: it grows"),
        ({"initial_stress": {"xx": 1.0}}, "block: it is under an initial stress"),
        ({"mesh": {**BLOCK, "periodic": True}}, "block: it is periodic"),
    ],
)
def test_a_case_without_modes_is_refused_before_anything_is_written(given, reason, tmp_path):
    file = tmp_path / "case.toml"
    scenario = carom.Scenario.from_dict(table(output={"modes": None}, **given))
    file.write_text(scenario.to_toml())
    arguments = ["run", str(file), "--out", str(tmp_path / "run"), "--set", "output.modes=4"]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 2
    told = " ".join(done.output.split())
    assert "output.modes" in told
    assert reason in told
    assert not (tmp_path / "run").exists()


def test_stages_have_no_modes():
    data = staging.scenario().model_dump(mode="json")
    data["output"]["modes"] = 3
    with pytest.raises(carom.InputError, match="modes are of a case of one analysis"):
        carom.Scenario.from_dict(data)


@pytest.mark.parametrize("count", [0, -1, 2.5, True])
def test_a_number_of_modes_is_a_whole_one(count):
    with pytest.raises(carom.InputError, match="modes"):
        carom.Scenario.from_dict(table(output={"modes": count}))


def test_bodies_that_vibrate_without_modes_are_told_of_at_the_start(tmp_path):
    metal = {"name": "plate", "material": "metal", "mesh": AWAY}
    stone = {"name": "stone", "kind": "rigid", "density": 1.0}
    stone["mesh"] = {**BLOCK, "corner": [9.0, 0.01]}
    case = carom.Scenario.from_dict(table(metal, stone))
    with pytest.warns(carom.CaromWarning, match="modes of plate .its material flows.$"):
        result = carom.run(case, out=tmp_path / "run")
    (warning,) = result.summary["warnings"]
    assert warning["code"] == "body-without-modes"
    assert warning["where"] == "output.modes"
    assert read_modes(result.path / layout.MODES).keys() == {"block"}


def test_a_rigid_body_has_no_vibration_to_miss(tmp_path):
    stone = {"name": "stone", "kind": "rigid", "density": 1.0, "mesh": AWAY}
    assert run(table(stone), tmp_path / "run").summary["warnings"] == []


def test_many_bodies_without_modes_are_a_short_line(tmp_path):
    metal = [
        {"name": f"plate{k}", "material": "metal", "mesh": {**BLOCK, "corner": [3.0 * k, 0.01]}}
        for k in range(1, 9)
    ]
    case = carom.Scenario.from_dict(table(*metal, output={"fields_every": 0.1}))
    with pytest.warns(carom.CaromWarning, match="plate5 .its material flows. and 3 more"):
        carom.run(case, out=tmp_path / "run")


def test_a_run_that_goes_on_writes_the_same(results, tmp_path):
    """And how many modes there are to be does not make it another case."""

    def stop(state):
        if state.time > 0.04:
            raise carom.Stop("enough")

    scenario = carom.Scenario.from_dict(table(output={"modes": 2}))
    carom.run(scenario, out=tmp_path / "run", observers=[carom.Observer(stop)])
    assert len(read_modes(tmp_path / "run" / layout.MODES)["block"].frequencies) == 2
    result = run(table(), tmp_path / "run", resume=True)
    assert result.summary["status"] == "completed"
    whole = (results.path / layout.MODES).read_bytes()
    assert (tmp_path / "run" / layout.MODES).read_bytes() == whole


def test_the_audit_goes_through(tmp_path):
    run(table(output={"audit": True}), tmp_path / "run")
    done = CliRunner().invoke(app, ["audit", str(tmp_path / "run")])
    assert done.exit_code == 0, done.output


def test_modes_that_are_not_found_do_not_take_the_run_with_them(tmp_path, monkeypatch):
    def fail(*_args, **_options):
        raise ArpackError(-9999)

    monkeypatch.setattr(splitting, "modes", fail)
    case = carom.Scenario.from_dict(table())
    with pytest.warns(carom.CaromWarning, match="modes were not found: .*ask for fewer"):
        result = carom.run(case, out=tmp_path / "run")
    assert result.summary["status"] == "completed"
    assert [one.code for one in result.warnings] == ["modes-not-found"]
    assert not (result.path / layout.MODES).exists()


@pytest.mark.parametrize(
    "spoil",
    [
        lambda text: text.replace("frequency", "pitch", 1),
        lambda text: "\n".join(text.splitlines()[:-3]) + "\n",
        lambda text: text.replace(",1,", ",one,").replace("0.02,", "soon,"),
        lambda _text: "",
    ],
    ids=["header", "cut", "no numbers", "empty"],
)
def test_a_damaged_table_is_told_of(results, tmp_path, spoil):
    file = tmp_path / "modes.csv"
    file.write_text(spoil((results.path / layout.MODES).read_text()))
    with pytest.raises(carom.InputError, match="no energies by modes of carom"):
        read_modes(file)
