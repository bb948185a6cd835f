"""Takes down what the tests hear from carom, and names the messages that no test provokes.

Heard is what a test looks at: an error that it expects, warnings that it collects, output that it
reads, findings that it asks for.
"""

import functools
import re
import subprocess
from pathlib import Path

import pytest
import tomlkit
from typer.testing import CliRunner

from carom.doctor import Finding

TEXTS = set()
"""All that was heard since `listen`."""

_LONGEST = 2000
"""Lines of more characters are pages and data, no messages."""

_HOLE = re.compile(r"\{[^{}]*\}")
_ROOT = Path(__file__).parents[1]
_CRATES = _ROOT / "crates"
_UNMET_FILE = Path(__file__).parent / "unmet-messages.toml"


def listen():
    """Begin; what is heard is added to `TEXTS` until the process ends."""
    _take_down(pytest.RaisesExc, "__exit__", lambda given, expected: given[2:3] if expected else ())
    _take_down(pytest.WarningsRecorder, "__exit__", lambda given, _: [w.message for w in given[0]])
    _take_down(pytest.CaptureFixture, "readouterr", lambda _, said: said)
    _take_down(CliRunner, "invoke", lambda _, done: [done.output])
    _take_down(subprocess.Popen, "communicate", lambda _, said: said)
    _take_down(Finding, "__init__", lambda given, _: given[3:])


def _take_down(owner, name, heard):
    """Let a method tell `TEXTS` what it was given and what it returns."""
    method = getattr(owner, name)

    @functools.wraps(method)
    def telling(*given, **options):
        result = method(*given, **options)
        TEXTS.update(str(text) for text in heard(given, result) if text)
        return result

    setattr(owner, name, telling)


def listed():
    """Return the messages on the page of the documentation."""
    page = (_ROOT / "docs" / "messages.md").read_text(encoding="utf-8")
    return set(re.findall(r"(?m)^- `(.*)`$", page))


def faults(met, listed):
    """Return a line for each message that the whole suite should have met, or should not.

    Parameters
    ----------
    met
        The listed messages that tests in Python met.
    listed
        The messages on the page.
    """
    groups = tomlkit.parse(_UNMET_FILE.read_text(encoding="utf-8")).unwrap()["group"]
    unmet = {text for group in groups for text in group["messages"]}
    met = met | met_in_rust(listed)
    return [
        f"{what}: {message}"
        for what, messages in (
            ("provoke this in a test", listed - met - unmet),
            (f"take this from {_UNMET_FILE.name}, as tests meet it", unmet & met),
            (f"take this from {_UNMET_FILE.name}, as nobody says it", unmet - listed),
        )
        for message in sorted(messages)
    ]


def in_rust():
    """Return the texts of three words or more that tests of the crates have, as one."""
    sources = []
    for path in _CRATES.rglob("*.rs"):
        source = path.read_text(encoding="utf-8")
        is_test = "tests" in path.parts or path.stem == "tests"
        sources.append(source if is_test else source.partition("#[cfg(test)]")[2])
    texts = re.findall(r'"((?:[^"\\]|\\.)*)"', "\n".join(sources))
    return [_plain(text.replace(r"\"", '"')) for text in texts if len(text.split()) >= 3]


def met(listed, texts):
    """Return which of the listed messages are in the texts.

    Parameters
    ----------
    listed
        Messages with ``{…}`` where values are put in.
    texts
        What was said. Words of it count for one message only, the longest that fits.
    """
    messages = sorted(listed, key=lambda message: -len(_HOLE.sub("", _own(message))))
    pieces = {message: list(filter(None, _HOLE.split(_own(message)))) for message in messages}
    patterns = {
        message: re.compile(".*?".join(f"({re.escape(piece)})" for piece in pieces[message]))
        for message in messages
    }
    found = set()
    for line in {_plain(line) for text in texts for line in text.splitlines()}:
        if len(line) > _LONGEST:
            continue
        free = line
        for message in messages:
            if not all(piece in free for piece in pieces[message]):
                continue
            if match := patterns[message].search(free):
                found.update(m for m in messages if _own(m) == _own(message))
                for group in range(1, len(pieces[message]) + 1):
                    start, end = match.span(group)
                    free = f"{free[:start]}{chr(0) * (end - start)}{free[end:]}"
    return found


def met_in_rust(listed):
    """Return which of the listed messages tests of the crates expect, in whole or by a part."""
    texts = in_rust()
    return met(listed, texts) | {
        message
        for message in listed
        if any(text in piece for piece in _HOLE.split(message) for text in texts)
    }


def _own(message):
    """Return a message without the names that begin and end it: some sources put them there."""
    return re.sub(r"^(\{[^{}]*\}(: )?)+|(\{[^{}]*\})+$", "", message)


def _plain(text):
    return " ".join(text.split()).replace("`", "'")
