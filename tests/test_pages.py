"""What pages of the documentation show in Python runs, and prints what they say."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

BLOCK = re.compile(r"^```(python|text)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def pieces(page):
    """Yield the Python blocks of a page, each with the text that stands next, or None."""
    blocks = BLOCK.findall(page)
    for (kind, code), after in zip(blocks, [*blocks[1:], ("", "")], strict=True):
        if kind == "python":
            yield code, after[1] if after[0] == "text" else None


@pytest.mark.parametrize(
    "page", ["README.md", "docs/how-to/results-in-python.md", "docs/how-to/own-steps.md"]
)
def test_a_page_prints_what_it_says(page, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    names = {}
    found = list(pieces((ROOT / page).read_text(encoding="utf-8")))
    assert found
    for code, expected in found:
        exec(compile(code, page, "exec"), names)
        printed = capsys.readouterr().out
        if expected is not None:
            assert printed == expected
