"""`carom report` of a study: its table, its picture, and the way to each run."""

import csv
import re
from urllib.parse import unquote

import pytest
from typer.testing import CliRunner

import carom
from carom.cli import app
from carom.io import layout
from carom.sweep import axis, sweep
from carom.sweep.page import write_study_page
from carom.sweep.worker import work
from reported import DISC


@pytest.fixture(scope="module")
def study(tmp_path_factory, module_pictures):
    """A study over the friction and a name that is no folder name, of which one run is refused."""
    out = tmp_path_factory.mktemp("study") / "friction & speed"
    brief = {**DISC["analysis"], "end_time": 0.2}
    case = carom.Scenario.from_dict({**DISC, "analysis": brief})
    axes = [axis("contact.friction=0,0.3"), axis("bodies.0.velocity=[0.5,-2.0],[1.0,-1.0]")]
    with pytest.MonkeyPatch.context() as patch:
        here = lambda tasks, jobs: ((k, work(task)) for k, task in enumerate(tasks))  # noqa: E731
        patch.setattr("carom.sweep.here", here)
        sweep(case, axes, out)
    return out


def report(*arguments):
    return CliRunner().invoke(app, ["report", *map(str, arguments)])


def test_a_study_has_a_page_with_a_row_and_a_link_for_each_run(study):
    """Symptom guarded against: carom report of a study said that it has no summary.json."""
    answer = report(study)
    assert (answer.exit_code, answer.output.strip()) == (0, str(study / layout.REPORT))
    text = (study / layout.REPORT).read_text(encoding="utf-8")
    links = [unquote(link) for link in re.findall(r'<a href="([^"]+)">completed</a>', text)]
    assert len(set(links)) == 4
    assert all((study / link).is_file() for link in links)
    assert {link.rpartition("/")[2] for link in links} == {layout.REPORT}
    with (study / "sweep.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        assert f'value="{row["energy_final"]}"' in text
        assert f'value="{row["friction"]}"' in text
    assert "friction work [J]" in text
    assert "contact.friction" in text
    assert "friction &amp; speed" in text
    assert report(study).exit_code == 0  # it replaces its own page


def test_runs_without_a_report_lead_to_what_they_have(study, tmp_path):
    import shutil

    copy = shutil.copytree(study, tmp_path / "copy")
    first, *others = sorted(path for path in copy.iterdir() if path.is_dir())
    (first / layout.REPORT).unlink()
    shutil.rmtree(others[0])
    text = write_study_page(copy, force=True).read_text(encoding="utf-8")
    assert f"/{layout.ENERGY_PLOT}" in text
    assert "2 runs of 4 without a report" in text
    assert text.count("<a href=") == 3


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("a,b\n1,2\n", "has no column status: it is no table of `carom sweep`"),
        ("", "has no column status"),
        ("\ufffd\x00", "has no column status"),
        ('a,status\n"1', "cannot be read: unexpected end of data"),
    ],
)
def test_a_table_that_is_none_of_a_study_is_refused(tmp_path, text, said):
    (tmp_path / "sweep.csv").write_text(text, encoding="utf-8")
    answer = report(tmp_path)
    assert answer.exit_code == 2
    assert answer.output.startswith("error: ")
    assert said in answer.output
    assert not (tmp_path / layout.REPORT).exists()


def test_a_table_that_is_cut_is_refused(study, tmp_path):
    text = (study / "sweep.csv").read_text(encoding="utf-8")
    (tmp_path / "sweep.csv").write_text(text.rpartition(",")[0], encoding="utf-8")
    answer = report(tmp_path)
    assert answer.exit_code == 2
    assert "has rows of other lengths" in answer.output


def test_the_page_of_a_study_opens_without_errors(study, opened, pages):
    write_study_page(study, force=True)
    for width in (360, 768, 1280):
        page = opened(study / layout.REPORT, viewport={"width": width, "height": 700})
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    with page.expect_download() as download:
        page.get_by_role("button", name="Save the table as CSV: Runs").click()
    assert "contact.friction" in download.value.path().read_text(encoding="utf-8")
    assert not pages.wrong


def test_the_page_of_a_study_has_the_warnings_of_runs_and_does_without_their_column(
    study, tmp_path
):
    with (study / "sweep.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for codes in ("penetration wave-speed", None):
        for row in rows:
            row["warnings"] = codes
        columns = [name for name in rows[0] if codes or name != "warnings"]
        with (tmp_path / "sweep.csv").open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, columns, extrasaction="ignore")
            writer.writeheader()
            writer.writerows(rows)
        text = write_study_page(tmp_path).read_text(encoding="utf-8")
        assert text.count("penetration wave-speed") == (len(rows) if codes else 0)
