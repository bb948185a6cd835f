"""``carom sweep``: studies whose failures are rows, and whose finished runs are kept."""

import csv
import json
import os
import sys
import time
from types import SimpleNamespace

import pytest

import carom
from carom import cli
from carom.errors import InputError
from carom.io import layout
from carom.io.progress import read_progress
from carom.sweep import axis, processes, sweep
from carom.sweep.figure import sweep_figure
from carom.sweep.study import folder, points
from carom.sweep.table import row, shown_cells
from carom.sweep.worker import Task, work
from carom.system.interrupt import Terminated

CASE = {
    "title": "Bounce",
    "analysis": {"end_time": 0.3, "time_step": 5e-3},
    "output": {"fields_every": 0.3, "history_every": 0.1},
    "materials": {
        "elastic": {
            "kind": "saint-venant-kirchhoff",
            "young": 2700.0,
            "poisson": 0.33,
            "density": 1.0,
        }
    },
    "bodies": [
        {
            "name": "disc",
            "material": "elastic",
            "mesh": {"kind": "disc", "centre": [0.0, 1.1], "radius": 1.0, "divisions": 2},
            "velocity": [2.0, -2.0],
        }
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}],
}


@pytest.fixture
def scenario():
    return carom.Scenario.from_dict(CASE)


@pytest.fixture
def here(monkeypatch):
    """Work on the tasks in this process, which takes no second to start."""
    worked = []

    def one_by_one(tasks, *, jobs):
        assert jobs >= 1
        for index, task in enumerate(tasks):
            worked.append(task.directory)
            yield index, work(task)

    monkeypatch.setattr("carom.sweep.here", one_by_one)
    return worked


def test_the_friction_that_varies_and_the_work_of_friction_have_different_titles():
    """Symptom guarded against: two columns "friction", one of them without a unit."""
    made = row({"contact.friction": 0.2}, {"status": "completed", "energy": {"friction": 1.25}})
    header, cells = shown_cells(["contact.friction"], [made])
    assert header[0] == "contact.friction"
    assert header[header.index("friction work [J]")] != header[0]
    assert cells[0][0] == "0.2"
    assert cells[0][header.index("friction work [J]")] == "1.25"
    assert len(set(header)) == len(header)


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("contact.friction=0:0.5:11", [0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5]),
        ("contact.friction=1:1:1", [1.0]),
        ("contact.friction=0.1, 0.3", [0.1, 0.3]),
        ("contact.condition=gap,midpoint", ["gap", "midpoint"]),
        ('bodies.0.velocity=[1.0, 0.0], [2.0, "t"]', [[1.0, 0.0], [2.0, "t"]]),
        ("bodies.0.mesh.divisions=2", [2]),
    ],
)
def test_values_of_an_axis(text, values):
    found = axis(text)
    assert found.key == text.partition("=")[0]
    assert list(found.values) == values


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("contact.friction", "--vary 'contact.friction': write KEY=START:STOP:COUNT"),
        ("=1", "--vary '=1': write"),
        ("a=0:x:3", "--vary a=0:x:3: START and STOP are numbers"),
        ("a=0:1:0", "--vary a=0:1:0: START and STOP must be finite, COUNT 1 to"),
        ("a=0:inf:2", "--vary a=0:inf:2: START and STOP must be finite"),
        ("a=1 2, 3 4", "a = 1 2: not a TOML value"),
    ],
)
def test_what_is_no_axis_is_refused(text, message):
    with pytest.raises(InputError) as caught:
        axis(text)
    assert str(caught.value).startswith(message)


def test_points_are_all_combinations_the_last_axis_fastest(scenario, tmp_path):
    axes = [axis("contact.friction=0,0.1"), axis("contact.condition=gap,midpoint")]
    made = points(scenario, axes, tmp_path)
    assert [tuple(p.values.values()) for p in made] == [
        (0, "gap"),
        (0, "midpoint"),
        (0.1, "gap"),
        (0.1, "midpoint"),
    ]
    assert made[2].scenario.contact.friction == 0.1
    assert made[2].scenario.contact.condition == "gap"
    assert made[2].directory == tmp_path / "friction=0.1_condition=gap"


def test_folders_are_told_apart_whatever_the_values():
    assert folder({"a.b": 0.5}) == "b=0.5"
    names = [
        folder({"a.x": "1/2"}),
        folder({"a.x": "1 2"}),
        folder({"a.x": 1, "b.x": 2}),
        folder({"b.x": 2, "a.x": 1}),
        folder({"a.x": "y" * 300}),
        folder({"a.x": "y" * 301}),
    ]
    assert len(set(names)) == len(names)
    assert all("/" not in name and len(name) < 120 for name in names)


@pytest.mark.parametrize(
    ("vary", "message"),
    [
        (["contact.sliding=0,1"], "contact.sliding: unknown key; known: condition, friction"),
        (["contact.friction=0,-1"], "contact.friction = -1: must be at least 0"),
        (["contact.friction=0", "contact.friction=1"], "--vary contact.friction: is given twice"),
        (["contact.friction=0:1:1000", "analysis.end_time=1:2:1000"], "--vary: 1000000 runs are"),
    ],
)
def test_keys_and_values_are_checked_before_anything_runs(here, scenario, tmp_path, vary, message):
    with pytest.raises(InputError) as caught:
        sweep(scenario, [axis(text) for text in vary], tmp_path / "out")
    assert str(caught.value).startswith(message)
    assert here == []
    assert list(tmp_path.iterdir()) == []


def test_a_study_leaves_a_table_of_what_its_runs_say(here, scenario, tmp_path):
    rows = sweep(scenario, [axis("contact.friction=0:0.4:3")], tmp_path)
    with (tmp_path / "sweep.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    for made, written, mu in zip(rows, table, (0.0, 0.2, 0.4), strict=True):
        summary = carom.Result.open(tmp_path / f"friction={mu}").summary
        (contact,) = summary["contacts"]
        assert made["contact.friction"] == float(written["contact.friction"]) == mu
        assert made["status"] == written["status"] == "completed"
        assert made["friction"] == float(written["friction"]) == summary["energy"]["friction"]
        assert made["peak_force"] == contact["peak_force"]
        assert made["contact_time"] == contact["release"] - contact["onset"]
    assert rows[0]["friction"] == 0.0 < rows[1]["friction"]


def test_finished_runs_of_the_same_case_are_not_made_again(here, scenario, tmp_path):
    axes = [axis("contact.friction=0,0.2")]
    first = sweep(scenario, axes, tmp_path)
    here.clear()
    assert sweep(scenario, axes, tmp_path) == first
    assert here == []
    wider = sweep(scenario, [axis("contact.friction=0,0.2,0.4")], tmp_path)
    assert [path.rpartition("/")[2] for path in here] == ["friction=0.4"]
    assert wider[:2] == first
    here.clear()
    sweep(scenario, axes, tmp_path, force=True)
    assert len(here) == 2


def test_results_of_another_case_are_replaced_by_force_only(here, scenario, tmp_path):
    axes = [axis("contact.friction=0.2")]
    (first,) = sweep(scenario, axes, tmp_path)
    here.clear()
    other = scenario.with_overrides(["bodies.0.spin=1.0"])
    with pytest.raises(InputError, match=r"friction=0\.2: has results of another case; .*--force"):
        sweep(other, axes, tmp_path)
    assert here == []
    assert sweep(scenario, axes, tmp_path) == [first]
    (replaced,) = sweep(other, axes, tmp_path, force=True)
    assert replaced["energy_initial"] > first["energy_initial"]


def test_the_table_of_another_study_is_replaced_by_force_only(here, scenario, tmp_path):
    sweep(scenario, [axis("contact.friction=0,0.3")], tmp_path)
    before = (tmp_path / "sweep.csv").read_bytes()
    finer = [axis("bodies.0.mesh.divisions=2,4")]
    with pytest.raises(InputError, match=r"sweep\.csv: is of another study; .* by --force$"):
        sweep(scenario, finer, tmp_path)
    assert (tmp_path / "sweep.csv").read_bytes() == before
    assert len(here) == 2, "nothing is run"
    more = sweep(scenario, [axis("contact.friction=0,0.1,0.3")], tmp_path)
    assert (len(more), len(here)) == (3, 3)
    assert len(sweep(scenario, finer, tmp_path, force=True)) == 2


def test_an_interrupted_run_is_made_again(here, scenario, tmp_path):
    axes = [axis("contact.friction=0.2")]
    sweep(scenario, axes, tmp_path)
    here.clear()
    file = tmp_path / "friction=0.2" / "summary.json"
    summary = json.loads(file.read_text())
    file.write_text(json.dumps(summary | {"status": "interrupted"}))
    assert sweep(scenario, axes, tmp_path)[0]["status"] == "completed"
    assert len(here) == 1


def test_failures_are_rows_with_their_reason(here, scenario, tmp_path):
    overlapping = [[0.0, 1.1], [0.0, 0.5]]
    rows = sweep(scenario, [axis(f"bodies.0.mesh.centre={str(overlapping)[1:-1]}")], tmp_path)
    assert [one["status"] for one in rows] == ["completed", "refused"]
    assert 'overlaps obstacle "floor"' in rows[1]["reason"]
    rows = sweep(
        scenario.with_overrides(["analysis.max_halvings=0", "bodies.0.spin=30"]),
        [axis("analysis.newton.max_iterations=1,50")],
        tmp_path / "iterations",
    )
    assert [one["status"] for one in rows] == ["failed", "completed"]
    assert rows[0]["reason"]
    assert rows[0]["steps"] is not None  # what there was until then


def test_what_cannot_be_written_is_a_row(scenario, tmp_path):
    (tmp_path / "file").touch()
    task = Task(scenario.model_dump(mode="json"), str(tmp_path / "file"))
    assert work(task)["status"] == "refused"
    assert work(task)["reason"] == f"{tmp_path / 'file'}: is a file; choose another --out"


def test_the_figures_of_a_run_without_contact_are_empty():
    made = row({"a": 1}, {"status": "completed", "energy": {"friction": 0.0}, "contacts": []})
    assert (made["first_touch"], made["peak_force"], made["contacts"]) == (None, None, 0)
    assert row({"a": 1}, {"status": "refused", "reason": "why"})["contact_time"] is None


def test_the_picture_has_a_curve_for_each_value_of_the_other_keys(here, scenario, tmp_path):
    axes = [axis("contact.friction=0:0.4:3"), axis("contact.condition=gap,midpoint")]
    rows = sweep(scenario, axes, tmp_path)
    drawn = sweep_figure("Bounce", [a.key for a in axes], rows).axes[1]
    assert drawn.get_ylabel() == "work of friction [J]"
    for curve, condition in zip(drawn.lines, ("gap", "midpoint"), strict=True):
        assert curve.get_label() == f"condition = {condition}"
        assert list(curve.get_xdata()) == [0.0, 0.2, 0.4]
        expected = [one["friction"] for one in rows if one["contact.condition"] == condition]
        assert list(curve.get_ydata()) == expected
    picture = sweep_figure("Bounce", ["contact.condition"], rows[:2])
    coefficients = [one["restitution"] for one in rows[:2]]
    assert [each.get_ylabel() for each in picture.axes[-2:]] == [
        "restitution",
        "tangential restitution",
    ]
    assert list(picture.axes[-2].lines[0].get_ydata()) == coefficients
    assert 0.5 < min(coefficients) < 1.1
    words = picture.axes[-2]
    assert [tick.get_text() for tick in words.get_xticklabels()] == ["gap", "midpoint"]


def study_rows(**columns):
    """Rows of a study over a key x, with what columns are in each; the rest is 1."""
    names = ("energy_initial", "energy_final", "friction", "plastic", "peak_force", "contact_time")
    count = len(next(iter(columns.values())))
    made = [dict.fromkeys(names, 1.0) | {"x": k, "status": "completed"} for k in range(count)]
    for name, values in columns.items():
        for one, value in zip(made, values, strict=True):
            one[name] = value
    return made


@pytest.mark.parametrize(
    ("column", "diagram", "values", "flat"),
    [
        ("energy_final", 0, [8.0, 8.0 + 2e-15, 8.0 - 4e-15], True),
        ("energy_final", 0, [8.0, 8.1, 7.9], False),
        ("friction", 1, [0.0, 3e-16, -1e-16], True),  # beside energies of 1 J
        ("friction", 1, [0.0, 3e-6, 1e-6], False),
        ("peak_force", 2, [1e7, 1e7 + 1e-8, 1e7], True),
        ("peak_force", 2, [1e-12, 2e-12, 3e-12], False),
        ("contact_time", 3, [2e-5, 2e-5 + 1e-20, 2e-5], True),
    ],
)
def test_round_off_is_drawn_as_a_flat_line(column, diagram, values, flat):
    """Symptom guarded against: final energies that differ by 1e-15 J, as a mountain range."""
    axes = sweep_figure("", ["x"], study_rows(**{column: values})).axes[diagram]
    drawn = axes.lines[0].get_ydata()
    low, high = axes.get_ylim()
    share = (max(drawn) - min(drawn)) / (high - low)
    assert low <= min(drawn) <= max(drawn) <= high
    assert share < 1e-6 if flat else share > 0.5


def test_a_study_of_zeros_is_drawn():
    keys = ("energy_initial", "energy_final", "friction", "peak_force")
    figure = sweep_figure("", ["x"], study_rows(**{key: [0.0, 0.0] for key in keys}))
    assert all(low < 0 < high for low, high in (axes.get_ylim() for axes in figure.axes[:3]))


def test_short_contacts_are_drawn_in_microseconds():
    axes = sweep_figure("", ["x"], study_rows(contact_time=[2e-5, 3e-5])).axes[3]
    assert axes.get_ylabel() == "time in contact [µs]"
    assert list(axes.lines[0].get_ydata()) == pytest.approx([20.0, 30.0])


@pytest.fixture
def case(tmp_path, scenario):
    (tmp_path / "case.toml").write_text(scenario.to_toml(), encoding="utf-8")
    return tmp_path / "case.toml"


def command(capsys, *arguments):
    with pytest.raises(SystemExit) as caught:
        cli.app(["sweep", *map(str, arguments)], prog_name="carom")
    captured = capsys.readouterr()
    return caught.value.code or 0, captured.out, captured.err


def test_the_command_runs_in_processes_and_tells_of_each(capsys, tmp_path, case):
    out = tmp_path / "study"
    options = ["--vary", "contact.friction=0,0.3", "--out", out, "--jobs", 1]
    status, printed, err = command(capsys, case, *options)
    assert (status, err) == (0, "")
    assert "2/2: contact.friction = " in printed
    names = {path.name for path in out.iterdir()}
    assert names == {"friction=0", "friction=0.3", "sweep.csv", "sweep.png"}


def test_failed_runs_are_status_3_and_bad_input_status_2(capsys, here, tmp_path, case):
    out = tmp_path / "study"
    centres = "bodies.0.mesh.centre=[0.0, 1.1], [0.0, 0.5]"
    status, printed, err = command(capsys, case, "--vary", centres, "--out", out)
    assert (status, err) == (3, "1 of 2 runs did not complete\n")
    assert "refused" in printed
    status, printed, err = command(capsys, case, "--vary", "contact.sliding=1", "--out", out)
    assert (status, printed) == (2, "")
    assert err.startswith(f"error: {case}: contact.sliding: unknown key")
    assert err.count("\n") == 1


def dies(task):
    if task.case["contact"]["friction"] > 0.1:
        os._exit(9)
    return {"status": "completed"}


def test_a_process_that_dies_is_a_row_and_the_others_go_on(monkeypatch, scenario):
    monkeypatch.setattr(processes, "work", dies)
    monkeypatch.setattr(processes, "START", "fork")  # this function is nowhere else
    tasks = [
        Task(scenario.with_values({"contact.friction": mu}).model_dump(mode="json"), "nowhere")
        for mu in (0.0, 0.2, 0.05)
    ]
    outcomes = dict(processes.here(tasks, jobs=2))
    assert [outcomes[n]["status"] for n in range(3)] == ["completed", "failed", "completed"]
    assert "died" in outcomes[1]["reason"]


def takes_steps(directory):
    running = read_progress(directory)
    return running is not None and running.progress is not None


def test_a_study_that_is_stopped_stops_its_runs(scenario, tmp_path):
    endless = scenario.with_values({"analysis.end_time": 1e6, "output.history_every": 1.0})
    tasks = [Task(endless.model_dump(mode="json"), str(tmp_path / name)) for name in "ab"]
    outcomes = processes.here([Task({}, str(tmp_path / "none")), *tasks], jobs=2)
    assert next(outcomes)[1]["status"] == "refused"
    while not all(takes_steps(tmp_path / name) for name in "ab"):
        time.sleep(0.05)
    outcomes.close()  # as Ctrl-C does; it returns when the processes have ended
    for name in "ab":
        summary = json.loads((tmp_path / name / layout.SUMMARY).read_text())
        assert summary["status"] == "interrupted"
        assert (tmp_path / name / layout.CHECKPOINT).exists()


def test_a_process_whose_study_has_stopped_begins_no_run(monkeypatch, scenario, tmp_path):
    monkeypatch.setattr("carom.sweep.worker.is_cut", lambda: True)
    task = Task(scenario.model_dump(mode="json"), str(tmp_path / "run"))
    assert work(task) == {"status": "interrupted", "reason": "the study was stopped"}
    assert not (tmp_path / "run").exists()


@pytest.fixture
def study(capsys, monkeypatch, tmp_path, case):
    """Run the command with something else in the place of its processes."""

    def run(instead):
        monkeypatch.setattr("carom.sweep.here", instead)
        options = ["--vary", "contact.friction=0,0.3", "--out", tmp_path / "out"]
        status, _, err = command(capsys, case, *options)
        return status, tmp_path / "out", err

    return run


@pytest.mark.parametrize(("stop", "status"), [(KeyboardInterrupt, 130), (Terminated, 143)])
def test_ctrl_c_tells_how_a_study_goes_on(study, stop, status):
    def interrupted(tasks, *, jobs):
        yield 0, work(tasks[0])
        raise stop

    found, out, err = study(interrupted)
    assert found == status
    assert err.startswith(
        f"1 of 2 runs have ended and are kept in {out}; the same command, without "
        "--force, goes on\n"
    )


def test_without_dask_a_scheduler_is_refused_with_the_remedy(monkeypatch, scenario, tmp_path):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"pip install 'carom\[dask\]'"):
        sweep(scenario, [axis("contact.friction=0")], tmp_path, scheduler="tcp://nowhere:1")


def test_a_scheduler_that_does_not_answer_is_named(monkeypatch, scenario, tmp_path):
    def client(address, timeout):
        raise OSError("Timed out trying to connect to tcp://nowhere:1 after 10 s")

    monkeypatch.setitem(sys.modules, "distributed", SimpleNamespace(Client=client))
    message = r"^--scheduler tcp://nowhere:1: no scheduler answers: Timed out trying to connect"
    with pytest.raises(InputError, match=message):
        sweep(scenario, [axis("contact.friction=0")], tmp_path, scheduler="tcp://nowhere:1")


def test_a_study_on_a_dask_cluster(scenario, tmp_path):
    distributed = pytest.importorskip("distributed", reason="Dask is not installed")
    cluster = distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    )
    with cluster:
        rows = sweep(
            scenario,
            [axis("contact.friction=0,0.2")],
            tmp_path,
            scheduler=cluster.scheduler_address,
        )
    assert [one["status"] for one in rows] == ["completed"] * 2
    assert (tmp_path / "friction=0.2" / "summary.json").exists()


def test_runs_side_by_side_take_one_thread_each(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "4")
    monkeypatch.delenv("RAYON_NUM_THREADS", raising=False)
    with processes._one_thread_each():
        assert {os.environ[name] for name in processes.ONE_EACH} == {"1"}
    assert os.environ["OMP_NUM_THREADS"] == "4"
    assert "RAYON_NUM_THREADS" not in os.environ
