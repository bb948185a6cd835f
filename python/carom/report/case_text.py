"""The case as TOML with its parts in colours."""

from __future__ import annotations

import re
from collections.abc import Iterator

from carom.display.markup import Html, element, join

_PARTS = re.compile(
    r"""(?P<comment>\#.*$)
    |(?P<header>^\s*\[\[?.*?\]\]?\s*(?=\#|$))
    |(?P<string>\"\"\".*?\"\"\"|"(?:\\.|[^"\\])*"|'[^']*')
    |(?P<key>[\w-]+(?:\.[\w-]+)*(?=\s*=[^=]))
    |(?P<number>(?<![\w.])[-+]?(?:\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?|inf|nan)(?![\w.]))
    |(?P<word>\b(?:true|false)\b)""",
    re.VERBOSE | re.MULTILINE,
)


def coloured(text: str) -> Html:
    """Return TOML text as markup."""
    return join(*_spans(text))


def _spans(text: str) -> Iterator[Html]:
    end = 0
    for match in _PARTS.finditer(text):
        yield join(text[end : match.start()])
        yield element("span", match.group(), class_=f"toml-{match.lastgroup}")
        end = match.end()
    yield join(text[end:])
