"""Finds the texts of errors and warnings in the sources, with ``{…}`` where values are put in.

Python is read by its syntax tree: a text counts by the call that it is given to. Rust is read by
patterns. Python cannot parse it without one more dependency, and to go through it token by token
(strings with their escapes and continued lines, comments, attributes, macros) would take more lines
than the patterns and find the same texts: what the core has to say are strings of several words,
and those that are no messages stand in the few places that `_NO_MESSAGE` names. What a pattern got
wrong would be seen, for it changes docs/messages.md, or is a message that no test has met.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]

RAISED = {
    "CertificateError",
    "ConvergenceError",
    "DamagedError",
    "Doubt",
    "Finding",
    "InputError",
    "MeshError",
    "PenetrationError",
    "Refused",
    "StorageError",
    "ValueError",
    "problem",
    "warn",
}
"""Names of what is called with a message."""

SAYING = {"_death", "_violation"}
"""Functions that return a message, or parts of one."""

_RUST_STRING = re.compile(r'"((?:[^"\\]|\\.)*)"', re.DOTALL)
_RUST_COMMENT = re.compile(r"(?m)^\s*//.*$|(?<=[;,{(\s])//[^\n]*$")
_NO_MESSAGE = re.compile(r"assert|expect\(|panic!|unreachable!|reason = |\[allow|\[expect|doc = ")
_HOLE = re.compile(r"\{[^{}]*\}")


def texts(root: Path = ROOT) -> dict[str, list[str]]:
    """Return the texts of every source that has some, by its path, in the order of the source."""
    found = {}
    for path in sorted(root.glob("crates/*/src/**/*.rs")):
        if path.stem not in ("contract", "tests", "hard") and "_contract" not in path.stem:
            found[path] = list(_rust(path.read_text(encoding="utf-8")))
    for path in sorted(root.glob("python/carom/**/*.py")):
        found[path] = list(_python(ast.parse(path.read_text(encoding="utf-8"))))
    return {
        path.relative_to(root).as_posix(): list(dict.fromkeys(lines))
        for path, lines in found.items()
        if lines
    }


def _says_something(text: str, *, words: int = 2) -> bool:
    own = _HOLE.sub("", text)
    return " " in text.strip() and len(re.findall(r"[A-Za-z]{2,}", own)) >= words


def _rust(source: str) -> Iterator[str]:
    """Every text of three words or more that no assertion has: the core prints nothing else."""
    source = _RUST_COMMENT.sub("", source.split("#[cfg(test)]", maxsplit=1)[0])
    for match in _RUST_STRING.finditer(source):
        before = re.split(r"[;{}]", source[max(0, match.start() - 200) : match.start()])[-1]
        text = re.sub(r"\\\n\s*", "", match[1]).replace('\\"', '"')
        if not _NO_MESSAGE.search(before) and _says_something(text, words=3):
            yield _HOLE.sub("{…}", text.replace("{{", "(").replace("}}", ")"))


def _python(module: ast.Module) -> Iterator[str]:
    """Every text that is given to one of `RAISED`, or to a name that is."""
    for scope in ast.walk(module):
        if not isinstance(scope, ast.FunctionDef):
            continue
        named: dict[str, list[ast.expr]] = {}
        for node in ast.walk(scope):
            if isinstance(node, ast.Assign):
                targets = node.targets[0]
                pairs = (
                    zip(targets.elts, node.value.elts, strict=False)
                    if isinstance(targets, ast.Tuple) and isinstance(node.value, ast.Tuple)
                    else [(targets, node.value)]
                )
                for target, value in pairs:
                    if isinstance(target, ast.Name):
                        named.setdefault(target.id, []).append(value)
        for node in ast.walk(scope):
            if scope.name in SAYING and isinstance(node, ast.Return | ast.Assign):
                yield from filter(_says_something, _template(node.value))
            if isinstance(node, ast.Call) and _carries(node):
                for text in _said(node, named):
                    if _says_something(text):
                        yield text


def _carries(call: ast.Call) -> bool:
    name, words = _name(call.func), [getattr(a, "value", None) for a in call.args]
    return (
        name in RAISED
        or (name == "add" and "warning" in words)
        or (name == "append" and _name(getattr(call.func, "value", call)) == "warnings")
        or (name == "echo" and any(keyword.arg == "err" for keyword in call.keywords))
    )


def _said(call: ast.Call, named: dict[str, list[ast.expr]]) -> Iterator[str]:
    for argument in call.args:
        for value in named.get(argument.id, []) if isinstance(argument, ast.Name) else [argument]:
            yield from _template(value)


def _name(function: ast.expr) -> str:
    return getattr(function, "id", None) or getattr(function, "attr", "")


def _template(value: ast.expr | None) -> Iterator[str]:
    """Return a string expression as text, one for every branch of a conditional."""
    if isinstance(value, ast.Constant) and isinstance(value.value, str):
        yield value.value
    elif isinstance(value, ast.JoinedStr):
        yield "".join(
            str(part.value) if isinstance(part, ast.Constant) else "{…}" for part in value.values
        )
    elif isinstance(value, ast.IfExp):
        yield from _template(value.body)
        yield from _template(value.orelse)
    elif isinstance(value, ast.BinOp):
        for left in _template(value.left):
            for right in _template(value.right):
                yield left + right
