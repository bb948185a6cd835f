"""Real runs are confirmed whatever the method; a number that was changed is found."""

import json
import re
import shutil
from pathlib import Path

import h5py
import pytest
from two_discs import LAYER, scenario

import carom
from carom import cli
from carom.auditing.catalogue import CHECKS
from carom.auditing.checks.ledger import BODY_COLUMNS, PAIR_COLUMNS
from carom.errors import InputError
from tampered import in_case, in_h5, in_summary, little_more

RUBBER = {"c10": 400.0, "bulk": 3000.0, "density": 1.0}

METHODS = [
    (condition, scheme)
    for condition in ("gap", "midpoint", "endpoint", "massless")
    for scheme in ("theta", "conserving")
]


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Run a method once and return its directory."""
    done = {}

    def directory(*method):
        if method not in done:
            out = tmp_path_factory.mktemp("results")
            carom.run(scenario(*method), out=out)
            done[method] = out
        return done[method]

    return directory


def refuted(directory):
    """Return what is refuted but for digests, which would find anything in case and tables."""
    return {check.name for check in carom.audit(directory).refuted} - {"files"}


@pytest.mark.parametrize("method", METHODS)
def test_every_method_is_confirmed(results, method):
    audit = carom.audit(results(*method))
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["Coulomb: cone"].count > 5  # there was contact
    energy = checks["kinetic energy"]
    assert energy.count == 4
    assert energy.figure < 1e-12
    assert checks["equation of motion"].figure < 1e-5
    assert ("energy of the step" in checks) == (method[1] == "conserving")
    assert ("blend" in checks) == (method == ("massless", "conserving"))
    assert carom.Result.open(results(*method)).summary["energy"]["prescribed"] > 0.1  # J


@pytest.mark.parametrize(
    "changes",
    [
        {"contact.targets": "faceted", "contact.sources": "both", "bodies.0.mass": "lumped"},
        {"materials.m.kind": "neo-hookean", "analysis.gravity": [1.0, -9.0]},
        {"materials.m.kind": "linear-elastic", "obstacles.0.velocity": [0.0, 0.0]},
        {"materials.m": {**RUBBER, "kind": "mooney-rivlin", "c01": 150.0}},
        {"materials.m": {**RUBBER, "kind": "yeoh", "c20": -80.0, "c30": 200.0}},
        {"bodies.1": LAYER, "bodies.0.mesh.centre": [0.3, 1.23], "analysis.end_time": 0.1},
        {"materials.m.damping": {"mass": 0.1, "stiffness": 1e-3}, "bodies.1.mesh.cell": "tri3"},
        {"analysis.scheme": {"kind": "theta", "theta": 0.6, "xi": 0.7}},
        {
            "bodies.0.initial_stress": {"xx": 50.0, "yy": -40.0, "zz": 30.0, "xy": 20.0},
            "materials.m.damping": {"mass": 0.0, "stiffness": 1e-4},
        },
        {"materials.m.kind": "linear-elastic", "bodies.0.initial_stress": {"yy": 5.0}},
        {"analysis.end_time": 0.175, "output.history_every": 0.05},
    ],
)
@pytest.mark.filterwarnings("ignore:.*vibrations")  # a stress sets in
@pytest.mark.parametrize("method", [("gap", "theta"), ("massless", "conserving")])
def test_what_a_case_can_vary_is_confirmed(tmp_path, method, changes):
    carom.run(scenario(*method, **changes), out=tmp_path)
    assert refuted(tmp_path) == set()


def test_steps_that_add_up_to_the_end_but_for_round_off_complete_a_run(tmp_path):
    """Symptom guarded against: 59 steps of 1 ms lack 7e-18 s of 0.059 s, and were refuted."""
    changes = {"analysis.end_time": 59 * 1e-3, "analysis.time_step": 1e-3}
    carom.run(scenario(**changes), out=tmp_path)
    assert refuted(tmp_path) == set()


def test_without_stored_steps_less_is_checked_and_that_is_said(tmp_path):
    carom.run(scenario(**{"output.audit": False}), out=tmp_path)
    assert not (tmp_path / "audit.h5").exists()
    audit = carom.audit(tmp_path)
    assert audit.confirmed
    assert "equation of motion" not in {check.name for check in audit.checks}
    assert any("output.audit = true" in left.store for left in audit.unchecked)


def in_history(column, row=60):
    """Change a number of the history; row 60 is at an output time."""

    def tamper(directory):
        path = directory / "history.csv"
        lines = path.read_text().splitlines()
        cells = lines[row + 1].split(",")
        index = lines[0].split(",").index(column)
        cells[index] = repr(float(cells[index]) * (1 + 1e-6) + 1e-6)
        lines[row + 1] = ",".join(cells)
        path.write_text("\n".join(lines) + "\n")

    return tamper


def in_ledger(entry, column):
    """Change a number of the ledger at an output time."""

    def tamper(directory):
        path = directory / "ledger.csv"
        lines = [line.split(",") for line in path.read_text().splitlines()]
        index = lines[0].index(column)
        row = next(line for line in lines if line[:2] == ["0.12", entry])
        row[index] = repr(little_more(float(row[index])))
        path.write_text("\n".join(",".join(line) for line in lines) + "\n")

    return tamper


def without_ledger_of(entry):
    def tamper(directory):
        path = directory / "ledger.csv"
        lines = path.read_text().splitlines(keepends=True)
        path.write_text("".join(line for line in lines if line.split(",")[1] != entry))

    return tamper


def called(status):
    def tamper(directory):
        path = directory / "summary.json"
        path.write_text(json.dumps({**json.loads(path.read_text()), "status": status}))

    return tamper


STEP = "audit.h5:steps/000001"
POINTS = "fields.vtkhdf:VTKHDF/PointData"
SURFACE_POINTS = "surface.vtkhdf:VTKHDF/PointData"

COLUMNS = [
    *("time", "kinetic", "strain", "total", "friction", "viscous", "plastic", "scheme"),
    *("normal_contact", "external", "defect", "momentum_x", "angular_momentum"),
    *("a.x", "b.v_y", "a.spin"),
    *("contacts", "min_gap", "normal_force", "certificate", "residual", "newton_iterations"),
    *("prescribed", "blend", "step_defect", "retried_steps", "shortest_step"),
    *("tip.u_x", "tip.v_y", "tip.vmid_x"),
]
EVERY_ROW = [
    "time",
    "kinetic",
    "total",
    "friction",
    "external",
    "defect",
    "prescribed",
    "step_defect",
    "momentum_y",
    "a.y",
    "b.v_x",
]

TAMPERED = {
    # Stored steps.
    "start displacement": in_h5(f"{STEP}/start/displacement", little_more),
    "end displacement": in_h5(f"{STEP}/end/displacement", little_more),
    "start velocity": in_h5(f"{STEP}/start/velocity", little_more),
    "end velocity": in_h5(f"{STEP}/end/velocity", little_more),
    "end time": in_h5(f"{STEP}/end@time", little_more),
    "start time": in_h5(f"{STEP}/start@time", little_more),
    "contact force": in_h5(f"{STEP}/end/contact_force", lambda f: 1.001 * f),
    "reaction": in_h5(f"{STEP}/end/contact_reaction", lambda f: 1.001 * f),
    "reaction at the start": in_h5(f"{STEP}/start/contact_reaction", lambda f: 1.001 * f),
    "contact gap": in_h5(f"{STEP}/end/contact_gap", little_more),
    "contact normal": in_h5(f"{STEP}/end/contact_normal", lambda n: 0.999 * n),
    "contact node": in_h5(f"{STEP}/end/contact_node", lambda n: n - 1),
    "contact node of nobody": in_h5(f"{STEP}/end/contact_node", lambda _: 100_000),
    "contact site": in_h5(f"{STEP}/end/contact_site", lambda n: n - 1),
    "contact site of nobody": in_h5(f"{STEP}/end/contact_site", lambda _: 100_000),
    "contact facet of nobody": in_h5(f"{STEP}/end/contact_facet", lambda _: 100_000),
    "contact target": in_h5(f"{STEP}/end/contact_target", lambda _: -2),
    "kinetic term": in_h5(f"{STEP}/ledger@kinetic", little_more),
    "friction term": in_h5(f"{STEP}/ledger@friction", little_more),
    # Fields.
    "displacement": in_h5(f"{POINTS}/displacement", little_more),
    "velocity": in_h5(f"{POINTS}/velocity", little_more),
    "nodal reaction": in_h5(f"{POINTS}/reaction", little_more),
    "stress": in_h5("fields.vtkhdf:VTKHDF/CellData/stress", little_more),
    "energy density": in_h5("fields.vtkhdf:VTKHDF/CellData/energy_density", little_more),
    "mesh": in_h5("fields.vtkhdf:VTKHDF/Points", little_more),
    "frame time": in_h5("fields.vtkhdf:VTKHDF/Steps/Values", lambda t: t - 1e-3),
    # History, at an output time and between two.
    **{f"history {column}": in_history(column) for column in COLUMNS},
    **{f"history {column} between": in_history(column, row=57) for column in EVERY_ROW},
    # The books of bodies and pairs.
    **{f"ledger {column} of a body": in_ledger("b", column) for column in BODY_COLUMNS},
    **{f"ledger {column} of a pair": in_ledger("a|floor", column) for column in PAIR_COLUMNS},
    "ledger of a body": without_ledger_of("b"),
    "ledger of a pair": without_ledger_of("a|b"),
    # Fields on boundaries.
    "friction energy": in_h5("surface.vtkhdf:VTKHDF/CellData/friction_energy", little_more),
    "pressure": in_h5("surface.vtkhdf:VTKHDF/CellData/pressure", little_more),
    "area": in_h5("surface.vtkhdf:VTKHDF/CellData/area", little_more),
    "displacement of facets": in_h5(f"{SURFACE_POINTS}/displacement", little_more),
    "facet": in_h5("surface.vtkhdf:VTKHDF/Connectivity", lambda n: n - 1),
    "time of facets": in_h5("surface.vtkhdf:VTKHDF/Steps/Values", lambda t: t - 1e-3),
    # Summary.
    "final energy": in_summary("energy", "final"),
    "friction work": in_summary("energy", "friction"),
    "largest drift": in_summary("energy", "max_drift"),
    "work of the floor": in_summary("energy", "prescribed"),
    "largest defect of a step": in_summary("energy", "max_step_defect"),
    "allowed certificate": in_summary("certificate", "tolerance_joule"),
    "books of a body": in_summary("bodies", 0, "contact"),
    "books of a pair": in_summary("pairs", 1, "prescribed"),
    "failed": called("failed"),
    "uncertified": called("uncertified"),
    "largest certificate": in_summary("certificate", "max_joule"),
    "steps": in_summary("steps", factor=2),
    "peak force": in_summary("contacts", 0, "peak_force", factor=0.1),
    "friction of a contact": in_summary("contacts", 0, "friction_work"),
    # The case.
    "friction coefficient": in_case("friction = 0.2", "friction = 0.21"),
    "less friction": in_case("friction = 0.2", "friction = 0.19"),
    "density": in_case("density = 1.0", "density = 1.0001"),
    "modulus": in_case("young = 2700.0", "young = 2700.01"),
    "Poisson's ratio": in_case("poisson = 0.33", "poisson = 0.3301"),
    "initial velocity": in_case("velocity = [3.0, -1.0]", "velocity = [3.0, -1.001]"),
    "radius": in_case("radius = 1.0", "radius = 1.001"),
    "divisions": in_case("divisions = 6", "divisions = 8"),
    "time step": in_case("time_step = 0.002", "time_step = 0.0025"),
    "motion of the floor": in_case("velocity = [0.5, 0.1]", "velocity = [0.5, 0.1001]"),
    "floor": in_case("point = [0.0, 0.0]", "point = [0.0, 0.0001]"),
    "law": in_case("saint-venant-kirchhoff", "neo-hookean"),
    "targets": in_case('targets = "smooth"', 'targets = "faceted"'),
}


@pytest.mark.parametrize("what", TAMPERED)
def test_a_changed_number_is_found(results, tmp_path, what):
    directory = tmp_path / "results"
    shutil.copytree(results("gap", "theta"), directory)
    TAMPERED[what](directory)
    assert refuted(directory)


@pytest.mark.parametrize(
    "tamper",
    [
        in_h5(f"{STEP}/blend", lambda a: a + 1e-3),
        in_h5(f"{STEP}/start/energy_debt", little_more),
        in_h5(f"{STEP}/end/energy_debt", little_more),
        in_history("blend"),
        in_history("prescribed"),
        in_ledger("a", "contact"),
        in_summary("max_blend"),
        in_h5(f"{STEP}/start/contact_reaction", lambda f: 1.001 * f),
        in_h5(f"{STEP}/start/contact_force", lambda f: 1.001 * f),
        in_case('condition = "massless"', 'condition = "gap"'),
        in_case('kind = "conserving"', 'kind = "theta"'),
    ],
)
def test_what_only_massless_contact_has_is_checked_too(results, tmp_path, tamper):
    directory = tmp_path / "results"
    shutil.copytree(results("massless", "conserving"), directory)
    tamper(directory)
    assert refuted(directory)


def test_a_run_further_from_coulombs_law_than_allowed_is_not_completed(results, tmp_path):
    directory = tmp_path / "results"
    shutil.copytree(results("gap", "theta"), directory)
    strict = carom.Result.open(directory).scenario.with_overrides(
        ["contact.certificate_tolerance=1e-18"]
    )
    (directory / "case.toml").write_text(strict.to_toml())
    in_summary("certificate", "tolerance_joule", factor=1e-9)(directory)
    assert refuted(directory) == {"summary: status"}
    called("uncertified")(directory)
    assert refuted(directory) == set()


def test_a_run_that_failed_is_audited_as_far_as_it_went(tmp_path):
    # Symptom guarded against: the last pair had a start that the failed step had overwritten.
    stops = {"analysis.newton.max_iterations": 1, "analysis.max_halvings": 0}
    flight = {"bodies.0.spin": 0.0, "output.fields_every": 0.004}  # rigid until the discs meet
    with pytest.raises(carom.ConvergenceError):
        carom.run(scenario(**stops, **flight), out=tmp_path)
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["status"] == "failed"
    assert summary["steps"] > 4
    assert refuted(tmp_path) == set()


def test_command_has_a_verdict_figures_and_an_exit_status(results, tmp_path, capsys):
    def command(*arguments):
        with pytest.raises(SystemExit) as caught:
            cli.app([str(argument) for argument in arguments], prog_name="carom")
        return caught.value.code or 0, capsys.readouterr()

    directory = tmp_path / "results"
    shutil.copytree(results("gap", "theta"), directory)
    status, printed = command("audit", directory)
    assert status == 0
    assert re.search(
        r"^confirmed: \d+ confirmed, \d+ cannot be checked from what is stored$", printed.out, re.M
    )
    in_summary("energy", "final")(directory)
    status, printed = command("audit", directory)
    assert status == 1
    assert "refuted: summary: energies: energies are those of" in printed.out
    assert re.search(r"^REFUTED: \d+ confirmed, 1 refuted, \d+ cannot be", printed.out, re.M)
    status, printed = command("audit", directory, "--json")
    assert status == 1
    found = json.loads(printed.out)
    assert found["confirmed"] is False
    failed = [check for check in found["checks"] if not check["confirmed"]]
    assert [check["where"] for check in failed] == ["final"]
    status, printed = command("audit", tmp_path)
    assert (status, printed.out) == (2, "")
    assert printed.err.startswith(f"error: {tmp_path}: has no case.toml")


def test_what_cannot_be_audited_is_said(results, tmp_path):
    with pytest.raises(InputError, match=r"has no case\.toml"):
        carom.audit(tmp_path)
    directory = tmp_path / "results"
    shutil.copytree(results("gap", "theta"), directory)
    with h5py.File(directory / "audit.h5", "r+") as file:
        file.attrs["schema"] = 99
    with pytest.raises(InputError, match="has schema 99"):
        carom.audit(directory)
    (directory / "audit.h5").unlink()
    with pytest.raises(InputError, match=r"has no audit\.h5, which its case asks for"):
        carom.audit(directory)


def test_a_history_without_a_column_cannot_be_audited(results, tmp_path):
    directory = tmp_path / "spoilt"
    shutil.copytree(results("gap", "theta"), directory)
    history = directory / "history.csv"
    history.write_text(history.read_text().replace("kinetic", "kinetik", 1))
    with pytest.raises(carom.InputError, match="cannot be audited: KeyError: 'kinetic'"):
        carom.audit(directory)


def test_every_check_is_in_the_documents_and_none_uses_the_core():
    root = Path(__file__).parents[3]
    page = (root / "docs" / "audit.md").read_text(encoding="utf-8")
    named = {name for row in re.findall(r"^\| ([^|]+) \|", page, re.M) for name in row.split(", ")}
    unsaid = {"kinetic energy", "strain energy", "total energy"}  # in one row, by their first words
    for name in CHECKS.keys() - unsaid:
        assert name in named or name.startswith("ledger: "), name
    for source in (root / "python" / "carom" / "auditing").rglob("*.py"):
        assert "_carom" not in source.read_text(encoding="utf-8")
