"""What pages of the documentation show in Python runs, and prints what they say."""

import re
from pathlib import Path

import pytest

import carom
from carom import cli

ROOT = Path(__file__).parents[1]

BLOCK = re.compile(r"^```(python|text)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


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
        carom.run(carom.Scenario.from_toml("two-bodies.toml"), out="results/two-bodies")
    return here


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "docs/tutorial.md",
        "docs/how-to/own-steps.md",
        "docs/how-to/read-the-ledger.md",
        "docs/how-to/results-in-python.md",
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
