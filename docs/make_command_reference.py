"""Write docs/commands.md from the commands of ``carom``.

``python docs/make_command_reference.py`` writes it, ``… --check`` says whether it is up to date
(exit status 1 if not).
"""

from __future__ import annotations

import inspect
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from generated import write_or_check

from carom.cli import COMMANDS, command

PAGE = Path(__file__).with_name("commands.md")

HEAD = """\
# Commands

<!-- Written by docs/make_command_reference.py; edit that script or the help of the commands. -->

`carom COMMAND --help` says the same in a terminal. Exit statuses: 0 success; 1 a file could not be
read or written, or an audit refutes the results; 2 bad input; 3 a step did not converge or left
Coulomb's law; 130 Ctrl-C; 143 SIGTERM. [What commands say when they fail](messages.md).
"""


def commands(group: Mapping[str, Any], path: str) -> Iterator[tuple[str, Any]]:
    """Yield every command of a group with its full name, in the order of the help."""
    for name, member in group.items():
        if hasattr(member, "commands"):
            yield from commands(member.commands, f"{path} {name}")
        else:
            yield f"{path} {name}", member


def cell(text: str) -> str:
    """Return a text as the cell of a table, its angle brackets and bars as they are."""
    return " ".join(text.split()).replace("|", "\\|")


def section(name: str, member: Any) -> Iterator[str]:  # noqa: ANN401 (Click's)
    """Yield the lines that describe a command."""
    arguments = [p for p in member.params if p.param_type_name == "argument"]
    shown = [p.metavar or p.name.upper() for p in arguments]
    shown = [word.strip("[]") for word in shown]
    words = [
        word + "…" * (p.nargs == -1) if p.required else f"[{word}]"
        for word, p in zip(shown, arguments, strict=True)
    ]
    yield f"\n## `{' '.join([name, *words])}`\n"
    yield inspect.cleandoc(member.help or "")
    rows = [(f"`{w}`", p, "") for w, p in zip(shown, arguments, strict=True)]
    for p in member.params:
        if p.param_type_name == "option" and p.name != "help":
            value = "" if p.is_flag else f" {p.metavar or p.name.upper()}"
            plain = p.default is None or p.is_flag or callable(p.default) or p.required
            rows.append((f"`{', '.join(p.opts)}{value}`", p, "" if plain else f"`{p.default}`"))
    if rows:
        yield "\n| | meaning | default |\n|---|---|---|"
        for word, p, default in rows:
            yield f"| {word} | {cell(p.help or '')} | {'required' if p.required else default} |"


def page() -> str:
    """Return the text of the page."""
    lines = [HEAD]
    for name, member in commands({name: command(name) for name in COMMANDS}, "carom"):
        lines += section(name, member)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(write_or_check({PAGE: page()}))
