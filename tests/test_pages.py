"""What pages of the documentation show in Python runs, and prints what they say."""

import io
import re
from pathlib import Path

import pytest
from rich.console import Console

import carom
from carom import cli
from carom.new.template import template
from carom.sweep import axis, sweep

ROOT = Path(__file__).parents[1]

BLOCK = re.compile(r"^```(python|text)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def blocks(page, kind):
    """Return the blocks of a kind on a page."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)


def pieces(page):
    """Yield the Python blocks of a page, each with the text that stands next, or None."""
    blocks = BLOCK.findall(page)
    for (kind, code), after in zip(blocks, [*blocks[1:], ("", "")], strict=True):
        if kind == "python":
            yield code, after[1] if after[0] == "text" else None


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    """A directory with what the reader of the tutorial has in front of them."""
    here = tmp_path_factory.mktemp("desk")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(here)
        cli.app(["new", "two-bodies"], standalone_mode=False)
        scenario = carom.Scenario.from_toml("two-bodies.toml")
        carom.run(scenario, out="results/two-bodies")
        brief = scenario.with_overrides(["analysis.end_time=1e-3"])
        sweep(brief, [axis("contact.friction=0,0.3")], Path("results/two-bodies-sweep"), jobs=1)
    return here


def test_the_tutorial_shows_the_case_and_the_table_of_its_run(desk, monkeypatch):
    monkeypatch.chdir(desk)
    (case,) = blocks("docs/tutorial.md", "toml")
    written = (desk / "two-bodies.toml").read_text(encoding="utf-8").splitlines()
    assert [line for line in case.splitlines() if line not in written] == []
    screen = io.StringIO()
    Console(file=screen, width=80).print(carom.Result.open("results/two-bodies"))
    (table,) = blocks("docs/tutorial.md", "text")
    # The largest defect and the certificate are round-off, which differs between processors.
    firm = [
        line for line in table.splitlines() if not re.match("│ (largest defect|certificate)", line)
    ]
    assert len(firm) > 6
    assert [line for line in firm if line not in screen.getvalue()] == []


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/tutorial.md",
        "docs/how-to/friction-laws.md",
        "docs/how-to/impacts.md",
        "docs/how-to/many-bodies.md",
        "docs/how-to/own-steps.md",
        "docs/how-to/pictures-and-films.md",
        "docs/how-to/plant-carom-in-your-code.md",
        "docs/how-to/press-fits.md",
        "docs/how-to/read-the-ledger.md",
        "docs/how-to/reduced-bodies.md",
        "docs/how-to/results-in-python.md",
        "docs/how-to/stages.md",
        "docs/how-to/sweep.md",
        "docs/tutorials/engineer.md",
        "docs/tutorials/researcher.md",
        "docs/tutorials/teacher.md",
    ],
)
def test_a_page_prints_what_it_says(page, desk, monkeypatch, capsys):
    monkeypatch.chdir(desk)
    names = {}
    found = list(pieces((ROOT / page).read_text(encoding="utf-8")))
    assert found
    capsys.readouterr()
    for code, expected in found:
        exec(compile(code, page, "exec"), names)
        printed = capsys.readouterr().out
        if expected is not None:
            assert printed == expected


def test_the_case_of_many_bodies_runs(tmp_path):
    (case,) = blocks("docs/how-to/many-bodies.md", "toml")
    file = tmp_path / "pile.toml"
    file.write_text(case, encoding="utf-8")
    with pytest.warns(carom.CaromWarning, match="waves will not be resolved"):
        result = carom.run(carom.Scenario.from_toml(file), out=tmp_path / "results")
    assert len(result.scenario.bodies) == 30
    energy = result.summary["energy"]
    assert energy["max_defect"] < 1e-12 * energy["final"]


def test_the_readme_is_short():
    """Symptom guarded against: 2,800 words, before which nobody saw anything move."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert len(text.split()) <= 900
    assert max(map(len, text.splitlines())) <= 120


def test_the_readme_shows_pictures_that_are_there_and_small():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    shown = [ROOT / name for name in re.findall(r'<img src="([^"]+)"', text)]
    assert len(shown) >= 10
    assert text.count("<img") == text.count("alt=")
    for file in shown:
        most = 1_500_000 if file.suffix == ".webp" else 200_000
        assert file.stat().st_size < most, file


def test_the_commands_under_the_pictures_of_the_readme_name_what_is_there():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for command in re.findall(r"<code>(.*?)</code>", text):
        program, *words = command.split()
        if words[0] == "new":
            assert template(words[1])
        else:
            assert program in ("carom", "python")
            assert (ROOT / words[-1]).exists(), command


def test_the_film_of_the_readme_is_what_its_commands_make():
    script = (ROOT / "docs/images/make_readme_images.py").read_text(encoding="utf-8")
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "--between 0 6 --speed 1 --reactions" in text
    assert "between=(0.0, 6.0), speed=1.0, reactions=True" in script


def test_pictures_of_the_readme_are_of_the_shipped_example():
    """Symptom guarded against: pictures on finer meshes than those of the case that they name."""
    for script in ("make_readme_images.py", "make_report_image.py"):
        text = (ROOT / "docs/images" / script).read_text(encoding="utf-8")
        assert '"examples" / "two_cylinders.toml"' in text
        replaced = re.findall(r'"([a-z][\w.]*)=', text)
        assert [key for key in replaced if not key.startswith("output.")] == []
        assert bool(replaced) == ("with_overrides" in text)
