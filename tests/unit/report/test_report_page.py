"""The page without a browser: its numbers, its escapes, and runs that are not whole."""

import base64
import hashlib
import html
import json
import re
import shutil
from html.parser import HTMLParser

import numpy as np
import pytest
from typer.testing import CliRunner

import carom
from carom import ConvergenceError, InputError
from carom.cli import app
from carom.display.markup import element, format_number
from carom.io import layout
from carom.report import write_report
from carom.report.codec import unpack
from carom.running.run import drive
from stand_in import FallingSimulation


class Page(HTMLParser):
    """Elements with their attributes, numbers by key, and the text outside scripts and styles."""

    def __init__(self, file):
        super().__init__()
        self.elements, self.numbers, self.text = [], [], ""
        self._raw = False
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.elements.append((tag, attributes))
        self._raw = tag in ("script", "style")
        if tag == "data":
            self.numbers.append([attributes["data-key"], float(attributes["value"]), ""])

    def handle_endtag(self, tag):
        self._raw = False

    def handle_data(self, data):
        if not self._raw:
            self.text += data
        if self.numbers and not self.numbers[-1][2]:
            self.numbers[-1][2] = data


def entry(summary, key):
    for name in key.split("."):
        summary = summary[int(name) if isinstance(summary, list) else name]
    return summary


def numbers_in(summary, key=""):
    if isinstance(summary, dict | list):
        items = summary.items() if isinstance(summary, dict) else enumerate(summary)
        for name, member in items:
            yield from numbers_in(member, f"{key}.{name}" if key else str(name))
    elif isinstance(summary, int | float):
        yield key


def report(*arguments):
    return CliRunner().invoke(app, ["report", *map(str, arguments)])


@pytest.fixture
def copy(disc, tmp_path):
    return shutil.copytree(disc.path, tmp_path / "copy")


def test_every_number_is_that_of_the_summary(disc):
    page = Page(disc.path / layout.REPORT)
    assert {key for key, _, _ in page.numbers} >= {
        key for key in numbers_in(disc.summary) if not isinstance(entry(disc.summary, key), bool)
    }
    for key, value, shown in page.numbers:
        assert value == entry(disc.summary, key), key
        plain = shown.replace("\u2212", "-").replace("\u202f", "").replace("×10", "e")
        plain = plain.translate(str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789"))
        assert float(plain) == pytest.approx(value, rel=5e-3), key


@pytest.mark.parametrize("run", ["disc", "ball"])
def test_every_column_that_is_no_number_has_a_unit(request, data_of, run):
    units = data_of(request.getfixturevalue(run).path / layout.REPORT).curves["units"]
    plain = {column for column, unit in units.items() if not unit}
    counts = {"contacts", "newton_iterations", "retried_steps"}
    assert plain == {"time", "residual", "blend"} | counts
    assert units[f"{run}.v_x"] == "m/s"
    assert units["total"] == "J"


def test_curves_are_the_columns_of_the_history(disc, data_of):
    columns = data_of(disc.path / layout.REPORT).curves["columns"]
    assert columns.keys() == disc.history.keys()
    for name, packed in columns.items():
        np.testing.assert_array_equal(unpack(packed), disc.history[name])


def test_retries_and_shorter_steps_are_drawn_where_there_were_any(disc, data_of, tmp_path):
    case = disc.scenario.model_dump(mode="json") | {"title": "hard"}
    case["analysis"] = {**case["analysis"], "newton": {"tolerance": 1e-9, "max_iterations": 4}}
    hard = carom.run(carom.Scenario.from_dict(case), out=tmp_path)
    history, nominal = hard.history, hard.summary["time_step"]
    assert history["retried_steps"].sum() == hard.summary["retried_steps"] > 0
    assert history["shortest_step"][1:].min() == pytest.approx(0.5 * nominal)
    panels = {p["id"]: p for p in data_of(tmp_path / layout.REPORT).curves["panels"]}
    assert [curve["column"] for curve in panels["step"]["curves"]] == ["shortest_step"]
    assert "retried_steps" in [curve["column"] for curve in panels["convergence"]["curves"]]
    easy = data_of(disc.path / layout.REPORT).curves["panels"]
    assert "step" not in [panel["id"] for panel in easy]


def test_books_of_bodies_and_pairs_are_those_of_the_ledger(disc, data_of):
    ledgers = data_of(disc.path / layout.REPORT).curves["ledgers"]
    assert {ledger["entry"] for ledger in ledgers} == disc.ledger.keys()
    for ledger in ledgers:
        for name, packed in ledger["columns"].items():
            stored = disc.ledger[ledger["entry"]][name]
            np.testing.assert_allclose(unpack(packed), stored, rtol=1e-6)


def test_an_obstacle_that_moves_is_where_it_is(disc, data_of):
    scene = data_of(disc.path / layout.REPORT).scene
    floor, lift, swing, ramp = scene["obstacles"]
    assert (floor["kind"], lift["kind"], lift["corner"]) == ("plane", "box", [3, 0])
    assert (ramp["kind"], ramp["points"][2]) == ("polygon", [5, 2.2])
    times = unpack(scene["times"])
    np.testing.assert_allclose(np.array(lift["travel"]), np.outer(times, [0.5, 0]))
    np.testing.assert_array_equal(floor["travel"], np.zeros((len(times), 2)))
    place = np.stack([0.3 * np.sin(4 * times), np.minimum(0.1, 0.5 * times)], axis=1)
    np.testing.assert_allclose(np.array(swing["travel"]), place, atol=1e-15)


def test_the_triangles_of_an_obstacle_are_in_the_page(museum, data_of):
    *_, wedge = data_of(museum.path / layout.REPORT).scene["obstacles"]
    points, triangles = unpack(wedge["points"]), unpack(wedge["triangles"])
    a, b, c = np.moveaxis(points[triangles], 1, 0).astype(float)
    volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
    assert volume == pytest.approx(0.5**3 / 6)


def test_an_obstacle_whose_file_is_gone_is_named(museum, tmp_path, data_of):
    copy = shutil.copytree(museum.path, tmp_path / "copy")
    case = (copy / layout.CASE).read_text()
    (copy / layout.CASE).write_text(case.replace("wedge.stl", "gone.stl"))
    page = write_report(copy)
    assert len(data_of(page).scene["obstacles"]) == 4
    assert "The obstacle wedge is not drawn" in page.read_text()


def test_text_of_the_case_stays_text(ball):
    page = Page(ball.path / layout.REPORT)
    title = ball.summary["title"]
    assert page.text.count(title) >= 2  # the head and the list of all numbers
    assert all(attributes.get("id") != "injected" for _, attributes in page.elements)
    assert not [tag for tag, _ in page.elements if tag == "img"]
    assert sum(tag == "script" for tag, _ in page.elements) == 4


@pytest.mark.parametrize("text", ["<b>", "a & b", '"quoted"', "'", "\u2028"])
def test_children_and_attributes_are_escaped(text):
    made = element("p", text, title=text)
    assert made == f'<p title="{html.escape(text)}">{html.escape(text)}</p>'
    assert element("div", made) == f"<div>{made}</div>"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.1, "0.1"),
        (-2.5, "\u22122.5"),
        (1.5e-7, "1.5\u202f×\u202f10⁻⁰⁷".replace("⁻⁰⁷", "⁻⁷")),
        (15000, "15\u202f000"),
        (-3, "\u22123"),
    ],
)
def test_numbers_are_set_as_in_print(value, text):
    assert format_number(value) == text


def test_only_the_scripts_of_the_page_may_run_and_nothing_is_fetched(disc):
    text = (disc.path / layout.REPORT).read_text(encoding="utf-8")
    (policy,) = [
        attributes["content"]
        for tag, attributes in Page(disc.path / layout.REPORT).elements
        if tag == "meta" and attributes.get("http-equiv") == "Content-Security-Policy"
    ]
    assert policy.startswith("default-src 'none'; script-src 'sha256-")
    scripts = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)
    assert len(scripts) == 3
    for script in scripts:
        digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
        assert f"'sha256-{digest}'" in policy
    assert not re.search(r'(?:src|href)="(?!#)', text)
    assert len(text) < 15e6


def test_the_page_is_where_it_was_asked_for(copy, tmp_path):
    file = tmp_path / "elsewhere.html"
    answer = report(copy, "--out", file)
    assert answer.exit_code == 0, answer.output
    assert answer.output.strip() == str(file)
    assert file.read_text() == (copy / layout.REPORT).read_text()


def test_another_file_is_not_overwritten_unless_forced(copy, tmp_path):
    file = tmp_path / "notes.html"
    file.write_text("mine")
    answer = report(copy, "--out", file)
    assert answer.exit_code == 2
    assert answer.output == f"error: {file}: is there already; give --force to replace it\n"
    assert file.read_text() == "mine"
    assert report(copy, "--out", file, "--force").exit_code == 0
    assert "carom report" in file.read_text()


def test_its_own_page_is_replaced_and_one_of_others_is_not(copy):
    own = copy / layout.REPORT
    own.write_text(own.read_text().replace("disc", "tampered"))
    assert report(copy).exit_code == 0
    assert "tampered" not in own.read_text()
    own.write_text("mine")
    assert report(copy).exit_code == 2
    assert own.read_text() == "mine"
    assert report(copy, "--out", copy).exit_code == 2


def test_a_directory_without_results_is_named(tmp_path):
    for directory in (tmp_path, tmp_path / "missing"):
        answer = report(directory)
        assert answer.exit_code == 2
        assert answer.output.startswith(f"error: {directory}: has no summary.json, history.csv or")
        assert answer.output.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("missing", "said"),
    [
        ((layout.SUMMARY,), "the run goes on, or was killed before its end"),
        ((layout.FIELDS,), "the bodies are not drawn"),
        ((layout.HISTORY, layout.LEDGER, layout.SURFACE, layout.CASE), "all 21 frames"),
        ((layout.SUMMARY, layout.HISTORY), "all 21 frames"),
    ],
)
def test_what_is_missing_is_said(copy, data_of, missing, said):
    for name in missing:
        (copy / name).unlink()
    page = write_report(copy)
    assert said in html.unescape(page.read_text())
    assert (data_of(page).scene is None) == (layout.FIELDS in missing)
    assert bool(data_of(page).curves["panels"]) == (layout.HISTORY not in missing)


@pytest.mark.parametrize("name", [layout.SUMMARY, layout.HISTORY, layout.FIELDS, layout.SURFACE])
def test_a_file_that_is_cut_off_is_said_to_be_so(copy, name):
    file = copy / name
    file.write_bytes(file.read_bytes()[: 300 if name == layout.SUMMARY else 20])
    text = html.unescape(write_report(copy).read_text())
    assert str(file) in text


def test_a_case_of_another_version_does_not_hide_the_results(copy, data_of):
    case = copy / layout.CASE
    case.write_text(case.read_text() + "\n[from_the_future]\nkey = 1\n")
    page = write_report(copy)
    assert "from_the_future" in page.read_text()
    assert data_of(page).scene["obstacles"] == []


@pytest.mark.parametrize(
    ("stop", "status"),
    [
        (ConvergenceError("did not <converge>", {}), "failed"),
        (KeyboardInterrupt(), "interrupted"),
    ],
)
def test_a_run_that_stops_leaves_a_page_that_says_so(scenario, tmp_path, stop, status):
    scenario = scenario.with_overrides(["output.report=true", "output.fields_every=0.25"])
    simulation = FallingSimulation(scenario, stop_at=0.6, stop=stop)
    with pytest.raises(type(stop)):
        drive(simulation, scenario, tmp_path)
    page = Page(tmp_path / layout.REPORT)
    assert [a["class"] for _, a in page.elements if a.get("role") == "alert"] == ["alert"]
    summary = carom.Result.open(tmp_path).summary
    assert summary["status"] == status
    assert summary["reason"] in page.text
    assert "What follows is what it has left" in page.text


def test_a_completed_run_with_doubtful_results_says_so_on_its_page(copy):
    def alerts(**changed):
        path = copy / layout.SUMMARY
        path.write_text(json.dumps({**json.loads(path.read_text()), **changed}))
        return [
            a["class"] for _, a in Page(write_report(copy)).elements if a.get("role") == "alert"
        ]

    assert alerts() == []
    deep = {"code": "penetration", "message": "nodes were up to 0.3 m inside what they touch"}
    deep |= {"where": "min_gap", "value": 0.3, "allowed": 0.01}
    assert alerts(warnings=[deep]) == ["alert doubts"]
    text = Page(copy / layout.REPORT).text
    assert "Warning: nodes were up to 0.3 m inside what they touch" in text
    assert "What follows is what it has left" not in text


def test_without_the_key_a_run_writes_no_page(ball, tmp_path):
    scenario = ball.scenario
    assert scenario.output.report is False
    result = carom.run(scenario.with_overrides(["analysis.end_time=0.01"]), out=tmp_path / "run")
    assert not (result.path / layout.REPORT).exists()


def test_the_command_line_names_the_page(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(
        """
[analysis]
kind = "static"
end_time = 1.0
time_step = 0.5
[materials.m]
kind = "linear-elastic"
young = 1e3
poisson = 0.3
density = 1.0
[[bodies]]
name = "block"
material = "m"
mesh = { kind = "rectangle", corner = [0, 0], size = [1, 1], divisions = [2, 2] }
[[motions]]
kind = "fixed"
body = "block"
on = "bottom"
[[motions]]
kind = "prescribed"
body = "block"
on = "top"
y = "-0.1*t"
"""
    )
    out = tmp_path / "out"
    answer = CliRunner().invoke(
        app, ["run", str(case), "--out", str(out), "--set", "output.report=true"]
    )
    assert answer.exit_code == 0, answer.output
    assert layout.REPORT in answer.output.replace("\n", "")
    assert "completed" in Page(out / layout.REPORT).text


def test_a_report_of_nothing_raises_for_python_too(tmp_path):
    with pytest.raises(InputError, match="name a results directory"):
        write_report(tmp_path)
