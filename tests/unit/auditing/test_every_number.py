"""Every number of summary and tables is pinned by others, or said not to be.

A run is read once. Then its numbers are changed one by one, in memory and without regard to the
digests of the files, and whatever the audit does not refute must be among what it says that it
cannot check in the untouched results.
"""

import copy

import numpy as np
import pytest
from two_discs import InMemory, scenario

import carom
from carom.auditing import audit_files
from carom.auditing.records.files import Files
from carom.auditing.report import Findings
from carom.auditing.steps.step import Step
from foreign_case import foreign_bodies, with_bodies

SPARSE = {"output.history_every": 0.01}
HALVED = {"analysis.newton.max_iterations": 6}
EVERYTHING = {"output.fields_every": 2e-3, "analysis.end_time": 0.06}
SMALL = {"output.fields_every": 0.1, "bodies.1.mesh.divisions": 4}
TRIANGLES = {"bodies.0.mesh.cell": "tri3", "bodies.1.mesh.cell": "tri3"}

RUNS = {
    "gap": ("gap", "theta", {}),
    "massless": ("massless", "conserving", {}),
    "sparse": ("gap", "theta", SPARSE),
    "halved": ("gap", "conserving", HALVED),
    "everything": ("gap", "theta", EVERYTHING),
    "foreign": ("gap", "conserving", TRIANGLES),
}
"""Condition, scheme and changes of runs; of one the second body is of a code that is not there."""

TAMPERED = ("gap", "massless", "sparse", "halved", "foreign")

COUNTS = {
    *("steps", "dofs", "newton_iterations", "factorisations", "retried_steps", "contacts"),
}
TIMES = {"onset", "release", "end_time", "time"}
ROUND_OFF = 1e-7
"""Figures below this are round-off: a millionth is added to them instead of 1 %."""


class RefutedError(Exception):
    """Something is refuted: there is no need to go on."""


CHECK = Findings.check


def check(findings, name, *noted):
    CHECK(findings, name, *noted)
    if not findings._checks[name].confirmed:
        raise RefutedError


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    """Run a case once, and return what it stored.

    What follows from a stored step alone, which is never changed here, is found for it once, and
    audits end at the first thing that they refute.
    """
    patch = pytest.MonkeyPatch()
    done, steps = {}, {}

    def once(model, step):
        if id(step) not in steps:
            steps[id(step)] = Step(model, step)
        return steps[id(step)]

    patch.setattr("carom.auditing.checks.states.Step", once)
    patch.setattr(Findings, "check", check)

    def files(name):
        if name not in done:
            condition, scheme, changes = RUNS[name]
            out = tmp_path_factory.mktemp(name)
            case = scenario(condition, scheme, **{**SMALL, **changes})
            if name == "foreign":
                case = with_bodies(case, [case.bodies[0], foreign_bodies(case)[1]])
            carom.run(case, out=out)
            done[name] = InMemory(Files(out))
            assert not refuted(done[name])
        return done[name]

    yield files
    patch.undo()


def refuted(files):
    try:
        audit_files(files)
    except RefutedError:
        return True
    return False


def unchecked(files):
    return {number for left in audit_files(files).unchecked for number in left.numbers}


def otherwise(key, value, step):
    """Return another value: 1 % more, one more, a step earlier, a letter more."""
    if isinstance(value, str):
        return f"{value}x"
    if isinstance(value, bool):
        return not value
    if value is None:
        return 0.2 if key == "release" else {}
    if key in COUNTS:
        return value + 1
    if key in TIMES:
        return value - step
    return value * 1.01 if abs(value) > ROUND_OFF else value + 1e-6


def leaves(value, path=()):
    """Yield the path of every number and text."""
    members = value.items() if isinstance(value, dict) else enumerate(value)
    if not isinstance(value, (dict, list)):
        yield path
        return
    for key, member in members:
        yield from (
            leaves(member, (*path, key)) if isinstance(member, (dict, list)) else ([(*path, key)])
        )


def said(name, listed):
    """Return whether a number is among those listed, by itself or by what it is a part of."""
    return any(name == entry or name.startswith(f"{entry}.") for entry in listed)


@pytest.mark.parametrize("run", TAMPERED)
def test_every_number_of_the_summary_is_pinned_or_said_not_to_be(read, run):
    files = read(run)
    listed, step = unchecked(files), files.summary["time_step"]
    loose = []
    for path in leaves(files.summary):
        summary = copy.deepcopy(files.summary)
        place = summary
        for key in path[:-1]:
            place = place[key]
        place[path[-1]] = otherwise(path[-1], place[path[-1]], step)
        name = "summary.json: " + ".".join(map(str, path))
        if not said(name, listed) and not refuted(files.changed(summary=summary)):
            loose.append(name)
    assert loose == []


def rows_of(files):
    """Return a row at an output time, while bodies touch, and the one before."""
    at = int(np.flatnonzero(files.history["time"] == 0.1)[0])
    return {"": at, ", between output times": at - 1}


@pytest.mark.parametrize("run", TAMPERED)
def test_every_number_of_the_history_is_pinned_or_said_not_to_be(read, run):
    files = read(run)
    listed, step = unchecked(files), files.summary["time_step"]
    loose = []
    rows = rows_of(files)
    if run in ("sparse", "halved"):
        del rows[""]  # as in the first run, where the step before a frame is stored
    for where, row in rows.items():
        for column, values in files.history.items():
            changed = values.copy()
            changed[row] = otherwise(column, float(values[row]), 0.5 * step)
            # What is believed at all times is believed between output times too.
            names = {f"history.csv: {column}", f"history.csv: {column}{where}"}
            if names & listed:
                continue
            if not refuted(files.changed(history={**files.history, column: changed})):
                loose.append(f"history.csv: {column}{where}")
    assert loose == []


@pytest.mark.parametrize("run", ["gap", "massless"])
def test_every_number_of_the_ledger_is_pinned(read, run):
    files = read(run)
    step, loose = files.summary["time_step"], []
    for where, row in rows_of(files).items():
        for entry, columns in files.ledger.items():
            back = row - len(files.history["time"])
            for column, values in columns.items():
                if np.isnan(values[back]):
                    continue
                changed = values.copy()
                changed[back] = otherwise(column, float(values[back]), 0.5 * step)
                ledger = {**files.ledger, entry: {**columns, column: changed}}
                if not refuted(files.changed(ledger=ledger)):
                    loose.append(f"ledger.csv: {entry}.{column}{where}")
    assert loose == []


def test_what_cannot_be_checked_is_little_where_all_is_stored(read):
    # With a row and a frame of every step nothing but round-off and what is no mechanics is left.
    assert unchecked(read("everything")) == {
        *("summary.json: version", "summary.json: factorisations", "summary.json: least_friction"),
        *("history.csv: certificate", "history.csv: residual", "history.csv: penetration"),
        *("summary.json: certificate.solver_joule", "summary.json: penetration"),
    }
