"""A minute with carom: it runs, explains and shows, and waits for nobody."""

import sys
import webbrowser
from io import StringIO
from types import SimpleNamespace

import pytest
from rich.console import Console
from typer.testing import CliRunner

import carom
from carom.cli import app, tour
from carom.io import layout

WINDOW = webbrowser.BackgroundBrowser("some")


def walk(*options):
    return CliRunner().invoke(app, ["tour", *map(str, options)])


def never(*_):
    raise AssertionError("a script was given a browser")


@pytest.fixture(scope="module")
def walked(tmp_path_factory):
    """The tour in a script, and the directory where it was."""
    out = tmp_path_factory.mktemp("tour") / "new"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(webbrowser, "open", never)
        return SimpleNamespace(out=out, answer=walk("--out", out))


def test_it_runs_an_impact_and_says_where_everything_is(walked):
    assert walked.answer.exit_code == 0, walked.answer.output
    result = carom.Result.open(walked.out / "run")
    assert result.summary["status"] == "completed"
    for name in ("two-bodies.toml", f"run/{layout.REPORT}", "run"):
        assert str(walked.out / name) in walked.answer.output.replace("\n", "")
        assert (walked.out / name).exists()


def test_it_tells_where_the_energy_went(walked):
    friction = carom.Result.open(walked.out / "run").history["friction"][-1]
    lines = walked.answer.output.splitlines()
    (line,) = [line for line in lines if "friction left – right" in line]
    assert f"{friction:.4g} J" in line
    assert any(block in line for block in tour.EIGHTHS[1:])
    (rest,) = [line for line in lines if "stay unexplained" in line]
    assert float(rest.split("at most ")[1].split(" J")[0]) < 1e-9


def test_what_it_names_to_go_on_with_are_commands(walked):
    from carom.cli import COMMANDS

    tail = walked.answer.output.partition("Go on with")[2]
    named = [line.split()[1] for line in tail.splitlines() if line.startswith("  carom ")]
    assert len(named) == len(tour.NEXT)
    assert set(named) <= set(COMMANDS)


def test_it_writes_over_nothing(walked):
    before = (walked.out / "two-bodies.toml").stat().st_mtime_ns
    again = walk("--out", walked.out)
    assert again.exit_code == 2
    assert "has files already; name a new directory with --out" in again.output
    assert (walked.out / "two-bodies.toml").stat().st_mtime_ns == before


@pytest.mark.parametrize(
    ("terminal", "environment", "browser", "opens"),
    [
        ("both", {}, WINDOW, True),
        ("input", {}, WINDOW, False),
        ("output", {}, WINDOW, False),
        ("both", {"CI": "true"}, WINDOW, False),
        ("both", {}, webbrowser.GenericBrowser("lynx"), False),  # it would take the terminal
        ("both", {}, None, False),
    ],
)
def test_a_page_is_opened_for_persons_with_a_browser_only(
    monkeypatch, terminal, environment, browser, opens
):
    def get():
        if browser is None:
            raise webbrowser.Error("there is none")
        return browser

    monkeypatch.setattr(webbrowser, "get", get)
    monkeypatch.setattr(sys, "stdin", SimpleNamespace(isatty=lambda: terminal != "output"))
    console = Console(file=StringIO(), force_terminal=terminal != "input")
    assert tour._can_open(console, environment) == opens


def test_its_books_fit_a_terminal_of_eighty_columns(walked):
    screen = StringIO()
    result = carom.Result.open(walked.out / "run")
    tour._show_books(Console(file=screen, width=80), result)
    assert "kinetic energy at the start" in screen.getvalue()
    assert "…" not in screen.getvalue()
