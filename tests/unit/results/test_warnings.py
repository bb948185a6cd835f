"""What speaks against results is part of them: in the summary, in Python, on pages and tables."""

import json
import math
import pickle
import re
import warnings
from pathlib import Path

import pytest
from typer.testing import CliRunner

import carom
from carom import cli
from carom.auditing import audit
from carom.doctor import examine
from carom.io import layout
from carom.report import write_report
from carom.results import doubts
from carom.running.recorder import Recorder
from carom.sweep import axis, sweep
from restarting import scenario

DOCS = Path(__file__).parents[3] / "docs"

FLOOR = {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}

SOFT = "materials.elastic.young=27"
"""The discs of `restarting` with waves of 6 m/s, which no solid has."""


def block(**changed):
    """A block that rests on a floor and has no energy."""
    return carom.Scenario.from_dict(
        {
            "analysis": {"end_time": 0.1, "time_step": 1e-2, "scheme": {"kind": "theta"}},
            "materials": {
                "e": {
                    "kind": "saint-venant-kirchhoff",
                    "young": 2700.0,
                    "poisson": 0.33,
                    "density": 1.0,
                }
            },
            "bodies": [
                {
                    "name": "block",
                    "material": "e",
                    "mesh": {
                        "kind": "rectangle",
                        "corner": [0, 0],
                        "size": [1, 0.5],
                        "divisions": [4, 2],
                    },
                }
            ],
            "obstacles": [FLOOR],
            **changed,
        }
    )


def ran(case, out, **options):
    """Run and return the results; what is warned of is looked at in them."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", carom.CaromWarning)
        return carom.run(case, out=out, **options)


def codes(result):
    return [warning.code for warning in result.warnings]


# Symptom guarded against: `carom.run` never said what the terminal warned of.
def test_a_run_in_python_warns_of_what_the_terminal_warns_of(tmp_path):
    with pytest.warns(carom.CaromWarning, match="waves run at 6.3") as caught:
        result = carom.run(scenario(SOFT), out=tmp_path)
    assert [str(one.message)[:10] for one in caught] == ["body left:", "body right"]
    assert {warning.filename for warning in caught} == {__file__}
    assert [str(one.message) for one in caught] == [str(one) for one in result.warnings]
    warning = result.warnings[0]
    assert (warning.code, warning.where) == ("wave-speed", "materials.elastic")
    assert warning.value == pytest.approx(6.3, abs=0.1)
    assert warning.allowed == 10.0
    assert json.loads((tmp_path / layout.SUMMARY).read_text())["warnings"][0] == {
        "code": "wave-speed",
        "message": str(warning),
        "where": "materials.elastic",
        "value": warning.value,
        "allowed": 10.0,
    }


def test_a_run_without_doubts_warns_of_nothing(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = carom.run(scenario(), out=tmp_path)
    assert result.summary["warnings"] == []
    assert result.warnings == ()


# Symptom guarded against: a defect of any size was no word worth where the run began at rest.
def test_a_ledger_that_does_not_close_is_warned_of_though_nothing_moved_at_the_start(tmp_path):
    with pytest.warns(carom.CaromWarning, match="the ledger misses 0.0[0-9]"):
        lifted = carom.run(block(obstacles=[{**FLOOR, "velocity": [0, 8]}]), out=tmp_path)
    energy = lifted.summary["energy"]
    assert energy["initial"] == energy["external"] == 0.0
    assert "ledger-defect" in codes(lifted)
    warning = next(one for one in lifted.warnings if one.code == "ledger-defect")
    assert warning.value == pytest.approx(energy["max_defect"] / energy["prescribed"], rel=0.2)
    assert warning.where == "energy.max_defect"


def test_much_that_vibrations_paid_for_folding_cells_is_warned_of(tmp_path):
    summary = ran(scenario(), tmp_path).summary
    energy = summary["energy"]["initial"]
    assert summary["repaid"] < 1e-6 * energy
    little, much = ({**summary, "repaid": part * energy} for part in (0.019, 0.03))
    assert "much-repaid" not in {doubt.code for doubt in doubts.doubts(little, scenario())}
    (doubt,) = (doubt for doubt in doubts.doubts(much, scenario()) if doubt.code == "much-repaid")
    assert doubt.value == pytest.approx(0.03, rel=0.05)
    with pytest.warns(carom.CaromWarning, match="vibrations took or gave 0.03 of the energy"):
        doubts.warn(doubt)


def test_a_block_at_rest_is_not_warned_of(tmp_path):
    assert codes(ran(block(), tmp_path)) == []


@pytest.mark.parametrize(
    ("changed", "share"),
    [
        ({}, 0.25),
        ({"initial": 10.0}, 0.1),
        ({"external": -5.0}, 0.2),
        ({"prescribed": -5.0, "external": 5.0}, 0.1),
        ({"max_drift": 0.0}, math.inf),
        ({"max_drift": 0.0, "max_defect": 0.0}, 0.0),
        ({"max_defect": math.inf}, math.inf),
    ],
)
def test_the_defect_is_relative_to_the_energy_that_came_or_was_there(changed, share):
    nothing = dict.fromkeys(("initial", "external", "prescribed"), 0.0)
    energy = {**nothing, "max_drift": 4.0, "max_defect": 1.0, **changed}
    assert doubts.defect_share(energy) == share


def summary(**changed):
    energy = dict.fromkeys(("external", "prescribed", "max_drift", "max_defect"), 0.0)
    energy["initial"] = 1.0
    return {"energy": energy, "penetration": {"worst": None}, "cross_check": None, **changed}


def found(**changed):
    return list(doubts.doubts(summary(**changed), scenario()))


def said(doubt):
    with pytest.warns(carom.CaromWarning) as caught:
        doubts.warn(doubt)
    return str(caught[0].message)


def test_depth_is_measured_by_what_is_allowed_there():
    def inside(depth, *between):
        worst = {"between": between, "depth": depth, "allowed": 0.02, "time": 0.5}
        return found(penetration={"worst": worst})

    assert inside(0.019, "left", "right") == []
    (deep,) = inside(0.021, "left", "right")
    assert (deep.code, deep.value, deep.allowed) == ("penetration", 0.021, 0.02)
    assert "left and right were up to 0.021 m inside one another at t = 0.5 s" in said(deep)
    (deep,) = inside(0.021, "left", "left")
    assert "left was up to 0.021 m inside itself" in said(deep)


def test_what_a_second_solver_does_not_confirm_is_a_doubt():
    check = {"problems": 9, "disagreements": 2, "time_of_max": 0.5, "unsolved": 1}
    both = found(cross_check=check)
    assert [one.code for one in both] == ["contact-not-unique", "contact-unchecked"]
    assert "2 of 9 contact problems have a second answer" in said(both[0])
    assert "1 of 9 contact problems were not solved by the second solver" in said(both[1])
    assert found(cross_check={**check, "disagreements": 0, "unsolved": 0}) == []


def test_a_step_too_long_for_waves_is_a_doubt_of_the_results_too(tmp_path):
    with pytest.warns(carom.CaromWarning, match="waves will not be resolved"):
        result = carom.run(block(analysis={"end_time": 0.1, "time_step": 2.5e-2}), out=tmp_path)
    warning = next(one for one in result.warnings if one.code == "coarse-step")
    assert (warning.where, warning.value) == ("analysis.time_step", 2.5e-2)
    assert warning.allowed < 2.5e-2


@pytest.mark.parametrize(
    "status", ["failed", "uncertified", "intersecting", "stopped", "interrupted"]
)
def test_runs_that_do_not_complete_have_their_warnings_too(tmp_path, monkeypatch, status):
    def end(state):
        raise carom.Stop if status == "stopped" else KeyboardInterrupt

    if status == "uncertified":
        monkeypatch.setattr("carom.running.run._violation", lambda *_: "too far from the law")
    if status == "intersecting":
        monkeypatch.setattr("carom.running.run._intersection", lambda *_: "too deep")
    observers = [carom.Observer(end)] if status in ("stopped", "interrupted") else []
    hard = ["analysis.newton.max_iterations=1", "analysis.max_halvings=0"]
    case = scenario(SOFT, *(hard if status == "failed" else []))
    expected = {
        "failed": carom.ConvergenceError,
        "uncertified": carom.CertificateError,
        "intersecting": carom.PenetrationError,
        "interrupted": KeyboardInterrupt,
    }
    with pytest.warns(carom.CaromWarning) as caught:
        if status == "stopped":
            carom.run(case, out=tmp_path, observers=observers)
        else:
            with pytest.raises(expected[status]):
                carom.run(case, out=tmp_path, observers=observers)
    result = carom.Result.open(tmp_path)
    assert result.summary["status"] == status
    assert "wave-speed" in codes(result)
    assert [str(one.message) for one in caught] == [str(one) for one in result.warnings]


class Doubting:
    """The native simulation of a core that has doubts of its own."""

    def __init__(self, simulation, said):
        self._simulation, self._said = simulation, said

    def __getattr__(self, name):
        return getattr(self._simulation, name)

    def summary(self):
        return {**self._simulation.summary(), "warnings": self._said}


def test_what_the_core_doubts_is_in_the_same_list(tmp_path):
    from carom.building.build import build
    from carom.running.run import drive

    said = {
        "code": "crushed",
        "message": "cells of left were crushed to 0.03 of their size",
        "where": "bodies.0",
        "value": 0.03,
        "allowed": 0.1,
    }
    case, told = scenario(SOFT, "analysis.end_time=0.02"), []
    result = drive(Doubting(build(case), [said]), case, tmp_path, notify=told.append)
    assert codes(result) == ["wave-speed", "wave-speed", "crushed"]
    assert result.summary["warnings"][-1] == said
    assert [doubt.as_summary() for doubt in told] == result.summary["warnings"]


def test_a_checkpoint_that_cannot_be_made_is_told_and_written_down(tmp_path, monkeypatch):
    from carom.building.build import build
    from carom.running.run import drive

    class Forgetful(Doubting):
        def checkpoint(self):
            raise ValueError("the state is not finite")

    case = scenario("analysis.end_time=0.05")
    with pytest.warns(carom.CaromWarning, match=": the state is not finite") as caught:
        result = drive(Forgetful(build(case), []), case, tmp_path)
    assert str(caught[0].message) == "no checkpoint at t = 0.02 s: the state is not finite"
    assert codes(result) == [*["checkpoint-not-made"] * 2, "end-state-not-made"]
    assert not (tmp_path / "end_state.h5").exists()
    assert {one.filename for one in caught} == {__file__}


def test_a_run_that_goes_on_has_the_warnings_of_the_one_that_never_stopped(tmp_path):
    whole = ran(scenario(SOFT), tmp_path / "whole")

    def stop(state):
        if state.time > 0.05:
            raise carom.Stop

    parts = tmp_path / "parts"
    ran(scenario(SOFT), parts, observers=[carom.Observer(stop)])
    with pytest.warns(carom.CaromWarning) as caught:
        resumed = carom.run(scenario(SOFT), out=parts, resume=True)
    assert resumed.summary["warnings"] == whole.summary["warnings"]
    assert len(caught) == len(whole.warnings)
    with pytest.warns(carom.CaromWarning) as again:
        carom.run(scenario(SOFT), out=parts, resume=True)
    assert len(again) == len(whole.warnings)


def test_results_of_versions_that_wrote_no_warnings_open(tmp_path):
    ran(scenario("output.audit=true"), tmp_path)
    path = tmp_path / layout.SUMMARY
    data = json.loads(path.read_text())
    del data["warnings"]
    path.write_text(json.dumps(data))
    result = carom.Result.open(tmp_path)
    assert result.warnings == ()
    assert "completed" in repr(result)
    write_report(tmp_path)


def test_the_audit_reads_results_with_warnings(tmp_path):
    ran(scenario(SOFT, "analysis.end_time=0.02"), tmp_path)
    assert audit(tmp_path).confirmed


def test_a_damaged_list_of_warnings_is_no_summary(tmp_path):
    ran(scenario("analysis.end_time=0.02"), tmp_path)
    path = tmp_path / layout.SUMMARY
    data = json.loads(path.read_text())
    path.write_text(json.dumps({**data, "warnings": [{"code": "penetration"}]}))
    with pytest.raises(carom.InputError, match=r"warnings\.0\.message is missing"):
        carom.Result.open(tmp_path)


def test_terminal_page_and_notebook_show_what_the_summary_has(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(scenario(SOFT, "analysis.end_time=0.02").to_toml())
    out = tmp_path / "out"
    shown = CliRunner().invoke(cli.app, ["run", str(case), "--out", str(out)])
    assert shown.exit_code == 0
    assert shown.output.count("warning: body left: waves run at 6.3") == 1
    assert re.search(r"│ warning +│ body left: waves run at", shown.output)
    result = carom.Result.open(out)
    assert str(result.warnings[0]) in write_report(out).read_text()
    assert "waves run at" in result._repr_html_()
    # Shown is what is written, whatever the numbers of the summary are.
    data = json.loads((out / layout.SUMMARY).read_text())
    data["warnings"] = []
    data["energy"]["max_defect"] = 1e9
    (out / layout.SUMMARY).write_text(json.dumps(data))
    assert "Warning:" not in write_report(out).read_text()


def test_a_study_has_the_codes_of_the_warnings_of_each_run(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(scenario("analysis.end_time=0.004").to_toml())
    out = tmp_path / "study"
    arguments = ["sweep", str(case), "--vary", "materials.elastic.young=27,2700", "--jobs", "1"]
    shown = CliRunner().invoke(cli.app, [*arguments, "--out", str(out)])
    assert shown.exit_code == 0, shown.output
    assert "materials.elastic.young = 27: completed, warnings: wave-speed" in shown.output
    head, soft, stiff = (out / "sweep.csv").read_text().splitlines()
    assert head.endswith(",warnings")
    assert soft.endswith(",wave-speed")
    assert stiff.endswith(",")


def test_a_warning_survives_the_way_to_another_process():
    warning = carom.CaromWarning("too far", "far", "energy", 2.0, 1.0)
    same = pickle.loads(pickle.dumps(warning))
    assert str(same) == "too far"
    assert (same.code, same.where, same.value, same.allowed) == ("far", "energy", 2.0, 1.0)


def test_every_code_is_on_the_page_of_results():
    page = (DOCS / "how-to" / "results-in-python.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"`([a-z]+(?:-[a-z]+)*)`", page.partition("## Warnings")[2]))
    made = re.compile(r'\b(?:Doubt|Note)\(\s*"([^"]+)"')
    sources = (DOCS.parent / "python" / "carom").rglob("*.py")
    used = {code for source in sources for code in made.findall(source.read_text("utf-8"))}
    only_checked = {"partial-step", "nothing-touches"}
    assert used - only_checked <= listed


def test_the_recorder_says_everything_once(tmp_path):
    from carom.building.build import build

    case, told = scenario(), []
    recorder = Recorder(tmp_path, case, build(case), case={}, notify=told.append)
    one, other = (doubts.Doubt(code, "is so", "here") for code in ("one", "other"))
    with recorder:
        for doubt in (one, other, one):
            recorder.doubt(doubt)
    assert told == [one, other]


def test_what_was_done_to_a_mesh_is_told_wherever_its_case_goes(tmp_path):
    import meshio

    points = [[0.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]
    meshio.write_points_cells(
        tmp_path / "square.vtu",
        [[*point, 0.0] for point in points],
        [("triangle", [[0, 2, 1], [0, 3, 2]])],
    )
    body = {"name": "block", "material": "e", "mesh": {"file": str(tmp_path / "square.vtu")}}
    case = block(bodies=[body], analysis={"end_time": 0.02, "time_step": 1e-2})
    with pytest.warns(carom.CaromWarning, match="numbered the other way round"):
        result = carom.run(case, out=tmp_path / "out")
    (warning,) = [one for one in result.warnings if one.code == "turned-cells"]
    assert (warning.where, warning.value) == ("bodies.0.mesh.file", 2)
    assert str(warning) in carom.check(case).warnings
    said = [f"{finding.what}; {finding.remedy}" for finding in examine(case).findings]
    assert str(warning) in said
    (row,) = sweep(case, [axis("materials.e.poisson=0.3")], tmp_path / "study", jobs=1)
    assert "turned-cells" in row["warnings"].split()
    (tmp_path / "case.toml").write_text(case.to_toml())
    shown = CliRunner().invoke(
        cli.app, ["run", str(tmp_path / "case.toml"), "--out", str(tmp_path / "x")]
    )
    assert "numbered the other way round" in shown.output
