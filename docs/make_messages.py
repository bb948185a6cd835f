"""Write docs/messages.md from the sources and docs/message-areas.toml.

``python docs/make_messages.py`` writes it, ``… --check`` says whether it is up to date (exit status
1 if not).
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import tomlkit
from generated import write_or_check
from message_texts import texts

from carom.messages import DATA_MESSAGES

PAGE = Path(__file__).with_name("messages.md")
AREAS = Path(__file__).with_name("message-areas.toml")

HEAD = """\
# Messages

<!-- Written by docs/make_messages.py; edit that script, message-areas.toml or the messages. -->

Every error, warning and finding that a user can meet, with cause and cure. `{…}` stands for a name
or a number.

An error is one line: the file, the key of the case as a dotted path, its value, what
is wrong, and, after a semicolon or in the second half, what to do. Nothing is written before the
case has been checked. Where a message says what to do, that is the cure; what each section says
besides is true of all its messages. Messages that say too little by themselves have a line below.

| exit status | meaning |
|---|---|
| 0 | success |
| 1 | a file could not be read or written, as on a full disk; an audit refutes the results |
| 2 | bad input: an `InputError` in Python |
| 3 | `ConvergenceError`: a step failed; `CertificateError`, `PenetrationError`: status of the run |
| 130, 143 | Ctrl-C, SIGTERM; `--resume` goes on |
"""


def areas() -> list[dict[str, Any]]:
    """Return the sections of the page: title, sources, cause and cure."""
    listed: list[dict[str, Any]] = tomlkit.parse(AREAS.read_text(encoding="utf-8")).unwrap()["area"]
    return listed


def area_of(path: str, listed: list[dict[str, Any]]) -> dict[str, Any] | None:
    """Return the section of a source: that with the longest beginning of its path."""
    fits = [
        (len(b), n) for n, area in enumerate(listed) for b in area["sources"] if path.startswith(b)
    ]
    return listed[max(fits)[1]] if fits else None


def page() -> str:
    """Return the text of the page."""
    listed, lines = areas(), [HEAD]
    found: list[list[str]] = [[] for _ in listed]
    for path, said in texts().items():
        area = area_of(path, listed)
        if area is None:
            raise SystemExit(f"{path} has messages; add it to an area of {AREAS}")
        found[listed.index(area)] += said
    for area, said in zip(listed, found, strict=True):
        lines += [f"\n## {area['title']}\n", f"**Cause.** {area['cause']}\n"]
        lines += [f"**Cure.** {area['cure']}\n"]
        # What has no words of its own passes a message of another source on.
        more = [text for text in DATA_MESSAGES.values() if text != "{error}"]
        more = more if area.get("data") else []
        notes = dict(area.get("notes", {}))
        for text in dict.fromkeys(_code(text) for text in [*more, *said]):
            lines += [f"- `{text}`", *([f"  <br>{notes.pop(text)}"] if text in notes else [])]
        if notes:
            raise SystemExit(f"notes on what nobody says in {AREAS}: {', '.join(notes)}")
    return "\n".join(lines) + "\n"


def _code(text: str) -> str:
    return " ".join(text.split()).replace("`", "'")


if __name__ == "__main__":
    sys.exit(write_or_check({PAGE: page()}))
