"""See that imports run one way: from higher rooms to lower ones, and nowhere in circles.

A room is a folder or a file at the top of a crate, or of the Python package. ``tools/rooms.toml``
lists the rooms of each from the ground up; what is lower must not import what is higher. Within a
room, and in crates that are not listed, files must not import one another in circles. A module that
only hands on names (``lib.rs``, ``__init__.py``) stands for the files that they come from.

``python tools/check_rooms.py`` prints what is wrong, with ``--count`` also how much there is.
"""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import tomlkit

ROOT = Path(__file__).resolve().parents[1]
ROOMS = Path(__file__).with_name("rooms.toml")


@dataclass(frozen=True)
class House:
    """A crate or package: its folder and the arrows between its files, named from there."""

    name: str
    files: list[str]
    arrows: dict[str, set[str]]

    def room(self, file: str) -> str:
        """Return the room that a file stands in."""
        return file.split("/", maxsplit=1)[0].removesuffix(".rs").removesuffix(".py")

    def circles(self) -> list[list[str]]:
        """Return the sets of files that import one another in a loop."""
        return [sorted(group) for group in _components(self.arrows) if len(group) > 1]

    def room_arrows(self) -> set[tuple[str, str]]:
        """Return the arrows between rooms."""
        return {
            (self.room(a), self.room(b))
            for a, heads in self.arrows.items()
            for b in heads
            if self.room(a) != self.room(b)
        }

    def upward(self, order: list[str]) -> list[tuple[str, str]]:
        """Return the arrows from a file to one of a higher room."""
        floor = {room: k for k, room in enumerate(order)}
        return sorted(
            (a, b)
            for a, heads in self.arrows.items()
            for b in heads
            if floor[self.room(a)] < floor[self.room(b)]
        )

    def unlisted(self, order: list[str]) -> list[str]:
        """Return the rooms that the list lacks or has in vain."""
        return sorted({self.room(f) for f in self.files} ^ set(order))


def _components(arrows: Mapping[str, Iterable[str]]) -> list[set[str]]:
    """Return the strongly connected components of a graph (Tarjan's algorithm)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found: list[set[str]] = []

    def visit(node: str) -> None:
        index[node] = low[node] = len(index)
        stack.append(node)
        for head in sorted(arrows.get(node, ())):
            if head not in index:
                visit(head)
                low[node] = min(low[node], low[head])
            elif head in stack:
                low[node] = min(low[node], index[head])
        if low[node] == index[node]:
            group: set[str] = set()
            while node not in group:
                group.add(stack.pop())
            found.append(group)

    for node in sorted(arrows):
        if node not in index:
            visit(node)
    return found


# Rust

COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
STRING = re.compile(r'"(?:\\.|[^"\\])*"', re.S)
TESTS = re.compile(r"#\[cfg\(test\)\]\s*mod\s+\w+\s*\{")
USE = re.compile(r"\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);")
CHILD = re.compile(r"(?<![\w:])([a-z_]\w*)::(\w+)")
PATH = re.compile(r"\b(crate|super|self)((?:::\w+)+)")


def rust_house(name: str, folder: Path) -> House:
    """Read the crate in a folder."""
    texts = {
        str(f.relative_to(folder)): _code(f.read_text(encoding="utf-8"))
        for f in sorted(folder.rglob("*.rs"))
    }
    modules = {_module(file): file for file in texts}
    handed = {file: dict(_handed_on(file, texts[file], modules)) for file in texts}
    arrows: dict[str, set[str]] = defaultdict(set)
    for file, text in texts.items():
        if file == "lib.rs":
            continue
        for path in _paths(text, file, modules):
            target = _resolve(path, file, modules, handed)
            if target is not None and target not in (file, "lib.rs"):
                arrows[file].add(target)
    return House(name, [f for f in texts if f != "lib.rs"], arrows)


def _code(text: str) -> str:
    """Return the code of a file without comments, strings and the modules of its tests."""
    text = STRING.sub('""', COMMENT.sub("", text))
    while found := TESTS.search(text):
        depth, end = 1, found.end()
        while depth and end < len(text):
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        text = text[: found.start()] + text[end:]
    return text


def _module(file: str) -> tuple[str, ...]:
    parts = Path(file).with_suffix("").parts
    if parts[-1] in ("mod", "lib"):
        parts = parts[:-1]
    return parts


def _flat(tree: str, prefix: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Return the paths of a ``use``, braces taken apart and new names left out."""
    tree = tree.strip()
    if "{" not in tree:
        path = re.sub(r"\s+as\s+\w+$", "", tree)
        yield (*prefix, *(p.strip() for p in path.split("::") if p.strip()))
        return
    head, _, rest = tree.partition("{")
    prefix = (*prefix, *(p.strip() for p in head.split("::") if p.strip()))
    inner, depth, start = rest[: rest.rindex("}")], 0, 0
    for k, letter in enumerate(inner + ","):
        depth += {"{": 1, "}": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            if inner[start:k].strip():
                yield from _flat(inner[start:k], prefix)
            start = k + 1


def _paths(
    text: str, file: str, modules: Mapping[tuple[str, ...], str]
) -> Iterator[tuple[str, ...]]:
    """Return all paths that begin in the crate; a module's ``use`` of its own folder is one, too.

    What a module hands on from its folder it need not know itself.
    """
    for public, tree in USE.findall(text):
        for path in _flat(tree):
            if path and path[0] in ("crate", "super", "self"):
                yield path
            elif path and not public and (*_module(file), path[0]) in modules:
                yield ("self", *path)
    rest = USE.sub("", text)
    for root, names in PATH.findall(rest):
        yield (root, *names.strip(":").split("::"))
    for child, name in CHILD.findall(rest):
        if (*_module(file), child) in modules:
            yield ("self", child, name)


def _handed_on(
    file: str, text: str, modules: Mapping[tuple[str, ...], str]
) -> Iterator[tuple[str, str]]:
    """Return the names that a module hands on, and the files that they come from."""
    for public, tree in USE.findall(text):
        for path in _flat(tree) if public else ():
            target = _resolve(path, file, modules, {})
            if target is None and path[:1] not in (("crate",), ("super",), ("self",)):
                target = _resolve(("self", *path), file, modules, {})
            if target is not None and target != file:
                yield path[-1], target


def _resolve(
    path: tuple[str, ...],
    file: str,
    modules: Mapping[tuple[str, ...], str],
    handed: Mapping[str, Mapping[str, str]],
) -> str | None:
    """Return the file that a path of another leads to; None if it leads out of the crate."""
    place = _module(file)
    if path[0] == "crate":
        place, path = (), path[1:]
    elif path[0] == "self":
        path = path[1:]
    elif path[0] != "super":
        return None
    while path and path[0] == "super":
        place, path = place[:-1], path[1:]
    while path and (*place, path[0]) in modules:
        place, path = (*place, path[0]), path[1:]
    target = modules.get(place)
    while target is not None and path and path[0] in handed.get(target, {}):
        target = handed[target][path[0]]
    return target


# Python


def python_house(folder: Path) -> House:
    """Read the package in a folder."""
    files = {str(f.relative_to(folder)): f for f in sorted(folder.rglob("*.py"))}
    package = folder.name
    arrows: dict[str, set[str]] = defaultdict(set)
    for file, path in files.items():
        for module, names in _imports(path, package):
            for target in _python_targets(module, names, files):
                if target not in (file, "__init__.py"):
                    arrows[file].add(target)
    doors = ("__init__.py", "__main__.py")  # of the house, which lead to any room
    for door in doors:
        arrows.pop(door, None)
    return House("python", [f for f in files if f not in doors], arrows)


def _imports(path: Path, package: str) -> Iterator[tuple[tuple[str, ...], list[str]]]:
    """Return the modules of the package that a file imports, and the names from each."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    typing_only = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if id(node) in typing_only:
            continue
        if isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            parts = node.module.split(".")
            if parts[0] == package:
                yield tuple(parts[1:]), [alias.name for alias in node.names]
        elif isinstance(node, ast.Import):
            for alias in node.names:
                parts = alias.name.split(".")
                if parts[0] == package and len(parts) > 1:
                    yield tuple(parts[1:]), []


def _python_targets(
    module: tuple[str, ...], names: list[str], files: Mapping[str, Path]
) -> Iterator[str]:
    for name in names or [""]:
        deeper = "/".join((*module, name)) if name else "/".join(module)
        for path in (deeper, "/".join(module)):
            found = next((f for f in (f"{path}.py", f"{path}/__init__.py") if f in files), None)
            if found is not None:
                yield found
                break


def houses() -> list[House]:
    """Read every crate and the package."""
    crates = [rust_house(c.name, c / "src") for c in sorted((ROOT / "crates").iterdir())]
    return [*crates, python_house(ROOT / "python" / "carom")]


def complaints(house: House, order: list[str] | None) -> list[str]:
    """Return what is wrong with a house, a line each."""
    found = [f"{house.name}: files in a circle: {', '.join(c)}" for c in house.circles()]
    if order is not None:
        found += [
            f"{house.name}: rooms.toml and the folder differ in the room {room!r}"
            for room in house.unlisted(order)
        ]
        if not house.unlisted(order):
            found += [f"{house.name}: {a} imports {b} above it" for a, b in house.upward(order)]
    return found


def main() -> int:
    """Check every house; the exit status is 1 if something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", action="store_true", help="say how much there is")
    options = parser.parse_args()
    orders = tomlkit.parse(ROOMS.read_text(encoding="utf-8")).unwrap()
    wrong = []
    for house in houses():
        order = orders.get(house.name)
        wrong += complaints(house, order)
        if options.count:
            rooms = {house.room(f) for f in house.files}
            upward = len(house.upward(order)) if order and not house.unlisted(order) else "-"
            print(
                f"{house.name}: {len(house.files)} files, {len(rooms)} rooms, "
                f"{len(house.room_arrows())} arrows between rooms, {upward} of files upward, "
                f"{len(house.circles())} circles"
            )
    print("\n".join(wrong), file=sys.stderr) if wrong else None
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
