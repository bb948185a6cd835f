"""Contact events, and the rows that they are checked by."""

import copy
import json
import shutil

import numpy as np
import pytest
from two_discs import InMemory, scenario

import carom
from carom.auditing import audit_files
from carom.auditing.records.files import Files

DROP = {"bodies.0.spin": 0.0, "bodies.1.mesh.centre": [6.0, 1.05], "bodies.1.velocity": [0.0, -1.0]}
"""The discs fall on the floor apart from one another."""

SPACE = {"obstacles": [], "analysis.gravity": [0.0, -2.0], "bodies.1.velocity": [-3.0, -1.0]}
"""The discs meet where there is no floor."""

RUNS = {
    "two pairs": ("gap", "theta", {}),
    "apart": ("midpoint", "conserving", DROP),
    "in space": ("massless", "conserving", SPACE),
    "halved": ("gap", "conserving", {"analysis.newton.max_iterations": 6}),
}


@pytest.fixture(scope="module")
def directories(tmp_path_factory):
    """Run a case once and return its directory."""
    done = {}

    def directory(name):
        if name not in done:
            condition, scheme, changes = RUNS[name]
            done[name] = tmp_path_factory.mktemp("results")
            carom.run(
                scenario(condition, scheme, **{"output.fields_every": 0.1, **changes}),
                out=done[name],
            )
        return done[name]

    return directory


@pytest.fixture(scope="module")
def read(directories):
    done = {}

    def files(name):
        if name not in done:
            done[name] = InMemory(Files(directories(name)))
        return done[name]

    return files


def refuted(files):
    return {check.name for check in audit_files(files).refuted}


def with_event(files, index, **changes):
    summary = copy.deepcopy(files.summary)
    summary["contacts"][index].update(changes)
    return files.changed(summary=summary)


def with_row(files, column, row, change):
    values = files.history[column].copy()
    values[row] = change(values[row])
    return files.changed(history={**files.history, column: values})


@pytest.mark.parametrize("run", RUNS)
def test_real_events_are_confirmed(read, run):
    assert refuted(read(run)) == set()
    assert len(read(run).summary["contacts"]) >= 1


@pytest.mark.parametrize("run", ["two pairs", "apart"])
@pytest.mark.parametrize("factor", [3.0, 1.02, 0.98])
@pytest.mark.parametrize("index", [0, 1])
def test_a_peak_force_that_no_row_has_is_found(read, run, index, factor):
    # Symptom: three times the force was confirmed, as a peak had only to cover the rows.
    files = read(run)
    peak = files.summary["contacts"][index]["peak_force"]
    changed = with_event(files, index, peak_force=factor * peak)
    assert "events: peak force" in refuted(changed)


@pytest.mark.parametrize("run", ["two pairs", "apart", "halved"])
@pytest.mark.parametrize("steps", [-1, 1, -3])
def test_an_event_that_begins_when_its_pair_does_not_touch_is_found(read, run, steps):
    # Symptom: an onset a step early was confirmed.
    files = read(run)
    onset = files.summary["contacts"][0]["onset"] + steps * 2e-3
    assert "events: times" in refuted(with_event(files, 0, onset=onset))


@pytest.mark.parametrize("steps", [-1, 1, 3])
def test_an_event_that_ends_when_its_pair_does_not_touch_is_found(read, steps):
    files = read("two pairs")
    release = files.summary["contacts"][0]["release"] + steps * 2e-3
    assert "events: times" in refuted(with_event(files, 0, release=release))


def test_an_event_that_goes_on_has_no_release_and_one_that_ended_has(read):
    files = read("two pairs")
    last = float(files.history["time"][-1])
    assert files.summary["contacts"][1]["release"] is None
    assert "events: times" in refuted(with_event(files, 1, release=last))
    assert "events: times" in refuted(with_event(files, 0, release=None))


def test_events_that_are_left_out_or_made_up_are_found(read):
    files = read("two pairs")
    events = files.summary["contacts"]

    def having(events):
        return refuted(files.changed(summary={**files.summary, "contacts": events}))

    assert "events: pairs" in having(events[:1])
    assert "events: pairs" in having([*events, {**events[0], "pair": ["b", "floor"]}])
    halves = [{**events[0], "release": 0.05}, events[1], {**events[0], "onset": 0.052}]
    assert "events: times" in having(halves)


def test_the_friction_of_an_event_is_that_of_its_pair_without_mass_too(read):
    files = read("in space")
    work = files.summary["contacts"][0]["friction_work"]
    assert work > 0.01  # J
    assert "events: friction" in refuted(with_event(files, 0, friction_work=1.001 * work))
    assert "events: friction" in refuted(with_event(files, 0, friction_work=0.999 * work))


def test_the_force_of_a_floor_is_known_from_momenta(read):
    # Symptom: the normal force of a row between two output times could be anything.
    files = read("apart")
    pressed = np.flatnonzero(files.history["normal_force"] > 0)
    between = [row for row in pressed if files.history["time"][row] not in (0.1, 0.2)]
    for row in (between[1], between[len(between) // 2]):
        for factor in (1.01, 0.99):
            changed = with_row(files, "normal_force", row, lambda force, f=factor: f * force)
            assert "events: force" in refuted(changed)
    left = {number for entry in audit_files(files).unchecked for number in entry.numbers}
    assert not any(number.startswith("history.csv: normal_force") for number in left)


@pytest.mark.parametrize("column", ["angular_momentum", "a.v_x", "b.y"])
def test_what_nothing_touches_goes_on_as_it_is(read, column):
    # Symptom: angular momentum in rows between output times could be anything.
    files = read("in space")
    touched = files.summary["contacts"][0]
    for time in (0.5 * touched["onset"], 0.5 * (touched["onset"] + touched["release"]), 0.19):
        row = int(np.abs(files.history["time"] - time).argmin())
        found = refuted(with_row(files, column, row, lambda value: 1.001 * value))
        assert found & {"row: angular", "row: flight", "row: centres", "row: momentum"}
    assert "row: flight" in {check.name for check in audit_files(files).checks}


def test_newton_iterations_of_halved_steps_are_whole_and_add_up(read):
    # Symptom: where steps were halved, any number of iterations was confirmed.
    files = read("halved")
    assert files.summary["retried_steps"] > 0
    rows = np.flatnonzero(files.history["retried_steps"] > 0)
    for row in (rows[0], rows[-1] + 1):
        for more in (0.25, 1.0):
            changed = with_row(files, "newton_iterations", row, lambda mean, m=more: mean + m)
            assert "summary: counts" in refuted(changed)
    count = files.summary["newton_iterations"]
    for said in (count - 1, count + 1):
        summary = {**files.summary, "newton_iterations": said}
        assert "summary: counts" in refuted(files.changed(summary=summary))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("newton = {tolerance = 1e-10", "newton = {tolerance = 1e-6"),
        ("tolerance = 1e-12, max_iterations = 10000", "tolerance = 1e-6, max_iterations = 10000"),
        ("[output]\n", "[output]\nmerge_contacts = 0.04\n"),
    ],
)
def test_a_case_that_was_edited_after_its_run_is_found(directories, tmp_path, old, new):
    # Symptom: a looser tolerance was confirmed, and made all that depends on it looser.
    directory = tmp_path / "results"
    shutil.copytree(directories("two pairs"), directory)
    case = directory / "case.toml"
    text = case.read_text(encoding="utf-8")
    assert old in text
    case.write_text(text.replace(old, new), encoding="utf-8")
    assert "files" in {check.name for check in carom.audit(directory).refuted}


def test_a_contact_solver_that_missed_its_tolerance_is_found(read):
    files = read("two pairs")
    scenario = files.scenario.with_overrides(["contact.solver.tolerance=1e-13"])
    strict = files.changed(scenario=scenario)
    strict._models = Files.models(strict)
    assert refuted(strict) == {"row: residual"}


@pytest.mark.parametrize("column", ["a.spin", "angular_momentum", "contacts", "normal_force"])
def test_a_row_that_was_edited_after_the_run_is_found(directories, tmp_path, column):
    # Symptom: spin, angular momentum and contacts between two output times could be anything.
    directory = tmp_path / "results"
    shutil.copytree(directories("two pairs"), directory)
    path = directory / "history.csv"
    lines = path.read_text().splitlines()
    cells = lines[41].split(",")
    index = lines[0].split(",").index(column)
    cells[index] = repr(float(cells[index]) + 1.0)
    lines[41] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n")
    assert "files" in {check.name for check in carom.audit(directory).refuted}


def test_results_without_digests_are_audited_and_that_is_said(directories, tmp_path):
    directory = tmp_path / "results"
    shutil.copytree(directories("two pairs"), directory)
    path = directory / "summary.json"
    summary = json.loads(path.read_text())
    del summary["files"]
    path.write_text(json.dumps(summary))
    audit = carom.audit(directory)
    assert audit.confirmed
    assert any("wrote no digests" in left.what for left in audit.unchecked)


def warned(files, *warnings, **changes):
    summary = {**files.summary, **changes, "warnings": list(warnings)}
    return refuted(files.changed(summary=summary))


def test_warnings_are_those_that_the_numbers_give_rise_to(read):
    files = read("two pairs")
    said = {"code": "penetration", "message": "too deep", "where": "penetration.worst"}
    assert "summary: warnings" not in warned(files)
    assert "summary: warnings" in warned(files, {**said, "value": 0.1, "allowed": 0.2})
    # Where it was too deep there must be one, with that figure and that limit.
    deep = {**said, "value": 0.1, "allowed": 0.01}
    inside = {"penetration": {"max_depth": 0.1, "worst": {"depth": 0.1, "allowed": 0.01}}}
    assert "summary: warnings" not in warned(files, deep, **inside)
    for changes in ({"value": 0.101}, {"allowed": 0.02}, {"where": "energy"}):
        assert "summary: warnings" in warned(files, {**deep, **changes}, **inside)
    assert "summary: warnings" in warned(files, **inside)


def test_warnings_of_the_case_have_its_figures(read):
    files = read("two pairs")
    speed = float(np.sqrt(2700 * 0.67 / (1.33 * 0.34)))  # m/s, of pressure waves
    slow = {"code": "wave-speed", "message": "no solid", "where": "materials.m", "allowed": 300.0}
    assert "summary: warnings" not in warned(files, {**slow, "value": speed})
    assert "summary: warnings" in warned(files, {**slow, "value": 1.01 * speed})
    coarse = {"code": "coarse-step", "message": "waves", "where": "analysis.time_step"}
    assert "summary: warnings" not in warned(files, {**coarse, "value": 2e-3, "allowed": 1e-3})
    assert "summary: warnings" in warned(files, {**coarse, "value": 3e-3, "allowed": 1e-3})


def test_a_certificate_is_measured_by_no_less_than_the_largest_energy(read):
    files = read("two pairs")
    certificate = files.summary["certificate"]
    largest = certificate["tolerance_joule"] / 1e-9  # J

    def said(reference, tolerance):
        parts = {"solver_joule": 0.0, "reference_joule": reference, "tolerance_joule": tolerance}
        summary = {**files.summary, "certificate": {**certificate, **parts}}
        return refuted(files.changed(summary=summary))

    assert said(largest, 1e-9 * largest) == set()
    # Where bodies rest on one another the work of reactions may be more.
    assert said(2 * largest, 1e-9 * (2 * largest)) == set()
    assert "summary: extremes" in said(0.9 * largest, 1e-9 * (0.9 * largest))
    assert "summary: extremes" in said(largest, 1.01e-9 * largest)


def test_contacts_are_merged_as_the_case_says_or_as_waves_run(read):
    files = read("two pairs")

    def merging(scenario, merge):
        pairs = [{**pair, "merge_contacts": merge} for pair in files.summary["pairs"]]
        changed = files.changed(scenario=scenario, summary={**files.summary, "pairs": pairs})
        changed._models = Files.models(changed)
        return refuted(changed)

    given = files.scenario.with_overrides(["output.merge_contacts=0.03"])
    assert merging(given, 0.03) == set()
    assert "events: times" in merging(given, 0.0301)
    # Of the discs, whose diameter is 2 m; a field of a model that was not given is left out.
    own = given.model_copy(
        update={"output": given.output.model_copy(update={"merge_contacts": None})}
    )
    waves = 2 / np.sqrt(2700 * 0.67 / (1.33 * 0.34))  # s
    assert merging(own, waves) == set()
    assert "events: times" in merging(own, 1.01 * waves)
