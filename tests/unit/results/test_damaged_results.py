"""Results that were changed, cut short or mixed up are refused with the file and what it lacks."""

import json
import shutil
import socket

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

import carom
from carom import InputError, cli
from carom.io.audit import read_steps
from carom.io.frames import Frames
from carom.io.history import read_history
from carom.report import write_report
from restarting import scenario


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A short run of one disc that touches nothing."""
    out = tmp_path_factory.mktemp("results") / "run"
    carom.run(scenario("analysis.end_time=0.02"), out=out)
    return out


@pytest.fixture
def results(run, tmp_path):
    """A copy of it that a test may spoil."""
    return shutil.copytree(run, tmp_path / "run")


def erased(directory, name, *places):
    with h5py.File(directory / name, "r+") as file:
        for place in places:
            del file[place]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,total\n0,1\n", 'not a history of carom: its first column is not "time"'),
        ("time,total\n0,one\n", "not a history of carom: could not convert string to float: 'one'"),
        ("", "not a history of carom: not enough values to unpack"),
    ],
)
def test_a_history_that_is_none_is_named(results, text, message):
    (results / "history.csv").write_text(text)
    with pytest.raises(InputError) as caught:
        read_history(results / "history.csv")
    assert str(caught.value).startswith(f"{results / 'history.csv'}: {message}")


def test_results_without_a_summary_or_with_a_broken_one_are_named(results):
    summary = results / "summary.json"
    summary.write_text("{")
    for read in (carom.Result.open, carom.audit):
        with pytest.raises(InputError, match=r"summary\.json: not JSON: Expecting property name"):
            read(results)
    summary.unlink()
    message = r"run: has no summary\.json; name a directory that `carom run` has finished$"
    for read in (carom.Result.open, carom.audit):
        with pytest.raises(InputError, match=message):
            read(results)


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (("plot",), "has no summary.json; name a directory"),
        (("modes",), "has no summary.json; name a directory"),
        (("compare",), "has no summary.json; name a directory"),
        (("picture", "--out", "a.png"), "no such file; name a results directory of `carom run`"),
        (("film", "--out", "a.gif"), "no such file; name a results directory of `carom run`"),
    ],
)
def test_a_file_in_the_place_of_results_is_bad_input(results, command, message):
    case = str(results / "case.toml")
    given = [case, case] if command == ("compare",) else [case]
    answer = CliRunner().invoke(cli.app, [*command, *given])
    assert answer.exit_code == 2, answer.output
    assert message in answer.output
    assert "Errno" not in answer.output


@pytest.mark.parametrize("text", ['title = "cut short"', None])
def test_runs_without_their_case_are_not_compared(run, results, tmp_path, text):
    (results / "case.toml").unlink()
    if text is not None:
        (results / "case.toml").write_text(text)
    drawn = tmp_path / "a.png"
    answer = CliRunner().invoke(cli.app, ["compare", str(run), str(results), "--out", str(drawn)])
    assert answer.exit_code == 2
    assert f"error: {results / 'case.toml'}: " in answer.output
    assert not drawn.exists()


def test_fields_at_a_time_that_the_run_does_not_have_are_refused(run):
    stress = carom.Result.open(run).fields["stress"]
    assert stress.at(0.0201).shape == stress[-1].shape  # no farther away than frames are apart
    for time in (np.nan, np.inf, -1.0, 5.0):
        with pytest.raises(InputError, match="no frame is near; those of the run are from 0 to"):
            stress.at(time)


def test_fields_that_are_none_are_named(results):
    fields = results / "fields.vtkhdf"
    erased(results, "fields.vtkhdf", "VTKHDF/PointData")
    with pytest.raises(InputError, match=r"fields\.vtkhdf: no fields of carom: .*PointData"):
        Frames(fields)
    erased(results, "fields.vtkhdf", "VTKHDF")
    with pytest.raises(InputError, match=r"fields\.vtkhdf: not a VTKHDF file of carom$"):
        carom.audit(results)
    fields.write_bytes(b"nothing")
    with pytest.raises(InputError, match=r"fields\.vtkhdf: not a VTKHDF file: .*signature not fou"):
        carom.audit(results)
    fields.unlink()
    with pytest.raises(InputError, match=r"fields\.vtkhdf: no such file; name a results directory"):
        Frames(fields)


def test_fields_without_a_frame_are_named(results):
    with h5py.File(results / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/Steps"].attrs["NSteps"] = 0
    with pytest.raises(InputError, match=r"fields\.vtkhdf: has no frames yet$"):
        Frames(results / "fields.vtkhdf")


def test_fields_that_lack_a_part_cannot_be_audited(results):
    erased(results, "fields.vtkhdf", "VTKHDF/PointData/velocity")
    with pytest.raises(InputError, match=r"fields\.vtkhdf: not fields of carom: .*velocity"):
        carom.audit(results)


def test_a_group_in_the_place_of_an_array_is_named(results):
    """Symptom guarded against: a traceback, for a group has neither a shape nor slices."""
    with h5py.File(results / "fields.vtkhdf", "r+") as file:
        del file["VTKHDF/PointData/velocity"]
        file.create_group("VTKHDF/PointData/velocity")
    with pytest.raises(InputError, match=r"fields\.vtkhdf: no fields of carom: "):
        Frames(results / "fields.vtkhdf")
    with pytest.raises(InputError, match=r"fields\.vtkhdf: not fields of carom: "):
        carom.audit(results)


def test_frames_that_cannot_be_read_are_named(results):
    frames = Frames(results / "fields.vtkhdf")
    erased(results, "fields.vtkhdf", "VTKHDF/PointData/velocity")
    with pytest.raises(InputError, match=r"fields\.vtkhdf: no fields of carom: .*velocity"):
        frames.field("velocity", 0)


def test_a_summary_of_a_thousand_brackets_is_not_json(results):
    """Symptom guarded against: the recursion of the reader ended in a traceback."""
    (results / "summary.json").write_text("[" * 100_000)
    with pytest.raises(InputError, match=r"summary\.json: not JSON: "):
        carom.Result.open(results)


def test_an_array_in_the_place_of_a_step_is_named(results):
    with h5py.File(results / "audit.h5", "r+") as file:
        first = min(file["steps"])
        del file[f"steps/{first}"]
        file[f"steps/{first}"] = 1.0
    with pytest.raises(InputError, match=r"audit\.h5: not steps of carom: "):
        next(read_steps(results / "audit.h5"))


def test_steps_of_another_version_or_of_nothing_are_named(results):
    steps = results / "audit.h5"
    with h5py.File(steps, "r+") as file:
        file.attrs["schema"] = 99
    with pytest.raises(InputError, match=r"audit\.h5: has schema 99, this version reads \d"):
        next(read_steps(steps))
    steps.write_bytes(b"nothing")
    with pytest.raises(InputError, match=r"audit\.h5: not steps of carom: .*signature not found"):
        next(read_steps(steps))
    steps.unlink()
    with pytest.raises(InputError, match=r"run: has no audit\.h5, which its case asks for$"):
        carom.audit(results)


def test_a_summary_that_is_no_table_is_told_of_in_the_report(results):
    (results / "summary.json").write_text("[]")
    page = write_report(results).read_text(encoding="utf-8")
    assert "summary.json: not a summary of carom: it is no table" in page


def test_a_mesh_that_is_not_that_of_the_case_cannot_be_audited(results):
    with h5py.File(results / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/CellData/body"][:] = 0
    with pytest.raises(InputError, match=r"body 'right' has no cells$"):
        carom.audit(results)


def test_bodies_that_are_swapped_in_the_mesh_cannot_be_audited(results):
    with h5py.File(results / "fields.vtkhdf", "r+") as file:
        body = file["VTKHDF/CellData/body"]
        body[:] = 1 - np.asarray(body[:])
    with pytest.raises(InputError, match=r"body 'left': the mesh is not numbered body after body"):
        carom.audit(results)


def test_what_the_auditor_does_not_know_is_named(results):
    metal = 'kind="j2-plasticity",young=9.0,poisson=0.3,density=1.0,yield_stress=1.0'
    case = scenario(f"materials.elastic={{{metal}}}", "bodies.0.initial_stress={xx=1e-3}")
    (results / "case.toml").write_text(case.to_toml(complete=True))
    with pytest.raises(InputError) as caught:
        carom.audit(results)
    assert str(caught.value) == "cannot audit the law 'j2-plasticity' yet"


def test_a_report_is_a_file(results):
    with pytest.raises(InputError, match=r"^.*: is a directory; name a file in it$"):
        write_report(results, out=results)


def test_an_auditor_that_stumbles_says_over_what(results):
    erased(results, "audit.h5", "steps")
    with h5py.File(results / "audit.h5", "r+") as file:
        file.create_group("steps/000000/start")
    with pytest.raises(InputError, match=r"audit\.h5: not steps of carom: "):
        carom.audit(results)
    (results / "summary.json").write_text('{"status": "completed"}')
    with pytest.raises(InputError, match=r"not a summary of carom: title is missing"):
        carom.audit(results)


def test_cells_and_nodes_that_are_not_of_the_case_cannot_be_audited(results):
    with h5py.File(results / "fields.vtkhdf", "r+") as file:
        file["VTKHDF/Types"][:] = 13
    with pytest.raises(InputError, match=r"cannot audit cells of VTK type 13 yet$"):
        carom.audit(results)


def test_a_run_that_left_nothing_is_told_of_by_watch(tmp_path):
    heard_of = {"pid": 2**22 + 1, "host": socket.gethostname(), "birth": "1", "updated": 0.0}
    (tmp_path / "progress.json").write_text(json.dumps({**heard_of, "progress": None}))
    done = CliRunner().invoke(cli.app, ["watch", str(tmp_path)])
    assert done.exit_code == 1
    assert done.output == (
        f"error: {tmp_path}: the run has died: process {2**22 + 1} on {socket.gethostname()} is "
        "gone; it left no checkpoint\n"
    )
