"""The page on contact problems does what it says."""

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

from carom import cli
from carom.friction import SOLVERS

PAGE = Path(__file__).parents[3] / "docs" / "friction.md"

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def test_what_the_page_shows_runs_and_prints_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names, printed, shown = {}, "", 0
    for language, block in BLOCK.findall(PAGE.read_text()):
        if language == "python":
            with contextlib.redirect_stdout(io.StringIO()) as out:
                exec(block, names)
            printed = out.getvalue()
        elif language == "text":
            assert block == printed
            shown += 1
        elif language == "sh":
            for line in block.splitlines():
                command, *arguments = shlex.split(line, comments=True)
                assert command == "carom"
                with pytest.raises(SystemExit) as ended:
                    cli.app(arguments, prog_name="carom")
                assert not ended.value.code, line
    assert shown == 2
    assert (tmp_path / "report" / "profile.png").exists()


def test_the_page_says_what_every_solver_is():
    page = PAGE.read_text()
    assert [name for name in SOLVERS if f"| `{name}` |" not in page] == []
