"""Stages are audited as runs of their own, and what goes on from one to the next."""

import pytest
from refuting import refuted_after

import carom
from tampered import in_csv, in_h5, in_summary, little_more


def leaning(**changes):
    """A block that is pulled up on a plate, thrown along it, and held where it has come to."""
    case = {
        "output": {"audit": True},
        "materials": {"m": {"kind": "neo-hookean", "young": 1e5, "poisson": 0.3, "density": 1e3}},
        "bodies": [
            {
                "name": name,
                "material": "m",
                "mesh": {"kind": "rectangle", "corner": at, "size": size, "divisions": n},
            }
            for name, at, size, n in (
                ("plate", [0.0, 0.0], [2.0, 0.3], [6, 2]),
                ("block", [0.5, 0.3], [0.5, 0.3], [3, 2]),
            )
        ],
        "motions": [{"kind": "fixed", "body": "plate", "on": "bottom"}],
        "contact": {"friction": 0.3, "condition": "midpoint", "sources": "second"},
        "stages": [
            {
                "name": "press",
                "analysis": {
                    "kind": "static",
                    "end_time": 1.0,
                    "time_step": 0.25,
                    "gravity": [0.0, -9.81],
                },
                "output": {"fields_every": 0.25, "history_every": 0.25},
                "motions": [
                    {"kind": "prescribed", "body": "block", "on": "left", "x": "-0.005*t*t"}
                ],
            },
            {
                "name": "throw",
                "analysis": {"end_time": 1.01, "time_step": 2e-3},
                "output": {"fields_every": 2e-3, "history_every": 2e-3},
                "velocities": [{"body": "block", "velocity": [0.4, 0.0], "spin": 0.2}],
                "removed_motions": [{"body": "block", "on": "left"}],
            },
            {
                "name": "hold",
                "analysis": {"kind": "static", "end_time": 2.01, "time_step": 0.5},
                "output": {"fields_every": 0.5, "history_every": 0.5},
                "motions": [{"kind": "fixed", "body": "block", "on": "top"}],
            },
        ],
    }
    return carom.Scenario.from_dict({**case, **changes})


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    out = tmp_path_factory.mktemp("leaning")
    carom.run(leaning(), out=out)
    return out


def test_stages_are_confirmed(run):
    audit = carom.audit(run)
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["equation of motion"].figure < 2e-6  # of forces up to 1 kN
    assert checks["supports"].figure < 1e-15
    assert checks["stored steps"].count > 1000
    assert checks["summary: stages"].count > 100


CHANGED = [
    (in_h5("audit.h5:steps/000002/end/displacement", little_more), "equation of motion"),
    (in_h5("audit.h5:steps/000004/start/velocity", little_more), "initial velocity"),
    (in_h5("audit.h5:steps/000007/ledger@strain", little_more), "ledger: strain"),
    (in_csv("history.csv", "external"), "row: defect"),
    (in_csv("history.csv", "block.v_x", row=8), "row: momentum"),
    (in_csv("history.csv", "block.top.force_y", row=-1), "support forces"),
    (in_summary("stages", 1, "energy", "friction"), "summary: stages"),
]


def test_changed_numbers_of_stages_are_found(run, tmp_path):
    def tamper(directory):
        for change, _ in CHANGED:
            change(directory)

    assert {found for _, found in CHANGED} <= refuted_after(run, tmp_path, tamper)


def test_what_is_held_stays_where_a_stage_found_it(run, tmp_path):
    def tamper(directory):
        path = directory / "case.toml"
        text = path.read_text()
        assert text.count('kind = "fixed"') == 2
        ends = text.rpartition('kind = "fixed"')
        held = 'kind = "prescribed"\nx = 1e-6\ny = 0.0'
        path.write_text(ends[0] + held + ends[2])

    assert "supports" in refuted_after(run, tmp_path, tamper)


def test_a_run_that_starts_from_another_is_confirmed_from_there_on(run, tmp_path):
    given = leaning().model_dump(mode="json")
    first = {**given, "stages": given["stages"][:1]}
    first["contact"] = {"friction": 0.3, "sources": "second"}
    carom.run(carom.Scenario.from_dict(first), out=tmp_path / "first")
    rest = {**given, "stages": given["stages"][1:]}
    rest["stages"][0]["removed_motions"] = []
    rest["stages"][0]["analysis"]["gravity"] = [0.0, -9.81]
    rest["initial"] = {"result": str(tmp_path / "first"), "time": 1.0}
    carom.run(carom.Scenario.from_dict(rest), out=tmp_path / "rest")
    audit = carom.audit(tmp_path / "rest")
    assert audit.refuted == ()
    assert "the state that the run starts from" in str([str(left) for left in audit.unchecked])
    tamper = in_h5("audit.h5:steps/000002/start/displacement", little_more)
    found = refuted_after(tmp_path / "rest", tmp_path, tamper)
    assert {"equation of motion", "velocity update"} <= found
