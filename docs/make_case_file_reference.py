"""Write docs/case-file.md and docs/carom.schema.json from the classes that read the case file.

``python docs/make_case_file_reference.py`` writes them, ``… --check`` says whether they are up to
date (exit status 1 if not).
"""

from __future__ import annotations

import json
import re
import sys
import types
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import annotated_types
from generated import write_or_check
from pydantic.fields import FieldInfo

from carom import Scenario, Table
from carom.case.description import PER_DIMENSION, Description, InPlane, InSpace, Name
from carom.case.docstrings import documented, summary
from carom.case.schema import case_file_schema

PAGE = Path(__file__).with_name("case-file.md")
SCHEMA = Path(__file__).with_name("carom.schema.json")

HEAD = """\
# The case file

<!-- Written by docs/make_case_file_reference.py; edit that script or the docstrings it reads. -->

A case is a TOML file, read by `carom run`, `carom check` and `carom.Scenario.from_toml`. All
quantities are in SI units; a body in the plane has a thickness, so that masses are in kg, forces in
N and energies in J. Coordinates and vectors have 2 components. A key that has a default may be left
out. An unknown key, a value of the wrong type and a value that is not allowed are errors (exit
status 2) that name the file, the key and the value.

[examples/two_cylinders.toml](../examples/two_cylinders.toml) and
[examples/two_bars.toml](../examples/two_bars.toml) are complete cases. Every table is a class of
the Python package with the same field names; the class is named under the heading of the table. An
object of a class knows its `kind`; where a table of the file can be of several kinds, it must say,
but for a dynamic analysis and a deformable body.

A *signal* is a function of time: a number; a formula of the time `t` as text, such as
`"0.1*(1 - cos(pi*t))"`; or a table `{ time = [0, 1], value = [0, 5] }` with straight lines between
its points, constant before and after (Python: `carom.Table`).

A formula knows `+ - * / ^` (or
`**`), brackets, comparisons (`<`, `<=`, `>`, `>=`, 1 where true and 0 where not), the constants
`pi` and `e`, and abs, acos, asin, atan, cos, cosh, exp, log (natural), max, min, sign, sin, sinh,
sqrt, step(x) (1 from x = 0 on), tan, tanh and where(condition, a, b).

A value can be replaced on the command line: `--set KEY=VALUE`, with a dotted key, list indices from
0, and a TOML value (a bare word counts as a string):

```sh
carom run CASE --set analysis.end_time=3 --set bodies.0.mesh.divisions=12 \\
    --set contact.condition=midpoint --set 'analysis.scheme={kind="theta", theta=1, xi=1}'
```
"""

CONDITIONS = """\
## What a contact condition gives and costs

In a dynamic analysis with the scheme `conserving`; a static one has `gap`.
[Exactness](exactness.md) has the figures, [a how-to](how-to/condition-and-solver.md) the choice.

| `contact.condition` | energy | at the end of a step | contact force | costs |
|---|---|---|---|---|
| `massless`, the default | kept to round-off | nothing is inside | quiet | half as much again |
| `midpoint` | kept to round-off | nodes on their targets | chatters | least |
| `gap` | impacts take some, less on finer meshes | nothing is inside | chatters | as `midpoint` |
| `endpoint` | nodes that stop lose theirs | nothing is inside | quiet | `midpoint`; more in heaps |

With `massless` a body keeps its mass where it touches if it is rigid or reduced, has no cells
inside, yields plastically, grows, has a friction law, or carries springs or masses there. Where
both sides of a pair keep theirs, or one that meets an obstacle, the pair is ruled as with
`midpoint`.
"""

RULES = """\
## Rules that join several keys

- `analysis.end_time`, `output.fields_every` and `output.history_every` are at least one
  `analysis.time_step`; of a case with stages, the shortest.
- A case has either an `analysis` or `stages`. A stage ends at least one of its steps after the one
  before.
- `analysis.max_halvings` is at most 30.
- `output.fields_every` and `output.history_every` that are left out are never less than a step.
- Names are unique over bodies, obstacles, springs and tracked points. `bodies.N.material` names a
  material, `output.track.N.body` a body.
- A tracked point is at most a quarter of the diagonal of the body's bounding box away from a node.
- A spring joins two places, one of a body at least. A point of a body that deforms is the nearest
  node, at most a quarter of the diameter of the body away; of a rigid body any point goes with it.
  A node without mass, as those that may touch with `massless` contact, takes no spring, nor does a
  body of revolution, nor a node inside a reduced body.
- Every body may touch every other body and every obstacle, unless `contact.pairs` says otherwise.
  An entry of `contact.pairs` names two different bodies, a body and an obstacle, or twice a body
  that may touch itself, and no two entries name the same pair.
- `contact.sources` and `contact.pairs.N.sources` matter between two bodies only: against an
  obstacle the nodes of the body are checked, and its facets against the corners of the obstacle.
  `"first"` is the body that comes first in `[[bodies]]`, or, where the pair has an entry in
  `contact.pairs`, in `between` of that entry.
- In the reference configuration bodies overlap neither one another nor an obstacle (deeper than
  1e-9 of the smallest edge), unless their pair is disabled. Overlaps that the digits of a mesh file
  cannot tell from touching are closed.
- A disc has an even number of `divisions`, or `rings` is given.
"""


@dataclass(frozen=True)
class Section:
    """A table of the case file: its header, and the classes that it may be."""

    header: str
    kinds: tuple[type[Description], ...]


def models(annotation: object) -> tuple[type[Description], ...]:
    """Return the descriptions that a value of this type may be made of."""
    if isinstance(annotation, type) and issubclass(annotation, Description):
        return (annotation,)
    found = (model for part in get_args(annotation) for model in models(part))
    return tuple(dict.fromkeys(found))


def fields(model: type[Description]) -> Iterator[tuple[str, FieldInfo]]:
    """Yield the fields of a class, ``kind`` first."""
    yield from sorted(model.model_fields.items(), key=lambda item: item[0] != "kind")


def sections(model: type[Description], path: str = "") -> Iterator[Section]:
    """Yield the tables within a table, depth first, in the order of its fields."""
    for name, field in fields(model):
        kinds = models(field.annotation)
        if not kinds or Table in kinds:
            continue
        key = f"{path}.{name}" if path else name
        origin = get_origin(field.annotation)
        if origin is tuple:
            header = f"[[{key}]]"
        elif origin is dict:
            key += ".NAME"
            header = f"[{key}]"
        else:
            header = f"[{key}]"
        yield Section(header, kinds)
        seen = set()
        for kind in kinds:
            for inner in sections(kind, key):
                if inner not in seen:
                    seen.add(inner)
                    yield inner


def parts(field: FieldInfo) -> tuple[object, list[object]]:
    """Return the type of a field without None and wrappers, and what is asked of its values."""
    annotation, asked = field.annotation, list(field.metadata)
    while True:
        origin = get_origin(annotation)
        if origin is Annotated:
            annotation, *more = get_args(annotation)
            asked += more
        elif origin in (Union, types.UnionType) and type(None) in get_args(annotation):
            # What may be one of several is described by the first; the text says the rest.
            annotation = next(part for part in get_args(annotation) if part is not type(None))
        else:
            break
    asked = [inner for outer in asked for inner in getattr(outer, "metadata", [outer])]
    return annotation, asked


COUNTS = {PER_DIMENSION: "D ", InPlane: "2 ", InSpace: "3 "}
PLAIN = {float: "number", int: "integer", str: "string", bool: "boolean"}


def type_of(field: FieldInfo) -> str:  # noqa: PLR0911 (one per type)
    """Return the TOML type of a field."""
    annotation, asked = parts(field)
    if annotation in PLAIN:
        return PLAIN[annotation]
    if Table in models(annotation):
        return "D signals" if PER_DIMENSION in asked else "signal"
    if number_beside_tables(annotation):
        return "number or table"
    if get_origin(annotation) is Literal:
        return PLAIN[type(get_args(annotation)[0])]
    if get_origin(annotation) is tuple:
        item = get_args(annotation)[0]
        if models(item):
            return "array of tables"
        if get_origin(item) in (Union, types.UnionType):
            # As above.
            item = get_args(item)[0]
        item, *of_item = get_args(item) if get_origin(item) is Annotated else [item]
        if get_origin(item) is tuple:
            return f"array of {COUNTS[of_item[0]]}numbers each"
        plain = "string" if get_origin(item) is Literal else PLAIN[item]
        return next((f"{COUNTS[a]}{plain}s" for a in asked if a in COUNTS), f"array of {plain}s")
    if get_origin(annotation) is dict:
        return "table of tables"
    return "table"


SIGNS = {
    annotated_types.Gt: (">", "gt"),
    annotated_types.Ge: ("≥", "ge"),
    annotated_types.Lt: ("<", "lt"),
    annotated_types.Le: ("≤", "le"),
}


def number_beside_tables(annotation: object) -> list[object]:
    """Return what is asked of the number that may stand in place of tables; nothing if none may."""
    tables = models(annotation)
    for part in get_args(annotation) if tables and Table not in tables else ():
        if get_origin(part) is Annotated and get_args(part)[0] is float:
            outer = get_args(part)[1:]
            return [rule for field in outer for rule in getattr(field, "metadata", ())]
    return []


def allowed(field: FieldInfo) -> str:
    """Return what values a field may have, beyond its type."""
    annotation, asked = parts(field)
    rules = []
    asked += number_beside_tables(annotation)
    if get_origin(annotation) is Literal:
        rules.append(", ".join(f"`{json.dumps(value)}`" for value in get_args(annotation)))
    if get_origin(annotation) is tuple:
        item = get_args(annotation)[0]
        if get_origin(item) is Literal:
            rules.append(", ".join(f'`"{value}"`' for value in get_args(item)))
        if get_origin(item) is Annotated:
            asked += [
                inner for outer in get_args(item)[1:] for inner in getattr(outer, "metadata", ())
            ]
    if set(get_args(Name)[1:]) & {one for one in asked if one.__hash__}:
        rules.append("no `.`, `/`, `\\` or space")
    for one in asked:
        if type(one) in SIGNS:
            sign, attribute = SIGNS[type(one)]
            rules.append(f"{sign} {getattr(one, attribute):g}")
        elif isinstance(one, annotated_types.MinLen):
            rules.append(f"{one.min_length} or more")
        elif getattr(getattr(one, "func", None), "__name__", "") == "_nonzero":
            rules.append("not zero")
    return ", ".join(rules)


def default(field: FieldInfo) -> str:
    """Return the default of a field as TOML."""
    if field.is_required():
        return "required"
    value: Any = field.get_default(call_default_factory=True)
    if value is None or value == {}:
        return "–"
    if isinstance(value, Description):
        return f'`"{value.kind}"`' if hasattr(value, "kind") else "see below"
    if isinstance(value, str):
        return f'`"{value}"`'
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    return f"`{list(value)}`" if isinstance(value, tuple) else f"`{value:g}`"


UNIT = re.compile(r"(?<!shape)(?<!in)\s\[([^\]]+)\]")


def row(name: str, field: FieldInfo, text: str, *, tag: bool) -> str:
    """Return the line of a key in its table; a tag tells the kinds of a table apart."""
    unit = UNIT.search(text)
    text = UNIT.sub("", text)
    text = re.sub(r",? ?shape \[\d\]", "", text)
    text = text.replace("default of `Contact`", "value in `[contact]`")
    cells = (
        f"`{name}`",
        type_of(field),
        unit[1] if unit else "",
        "required" if tag else default(field),
        allowed(field),
        text,
    )
    return f"| {' | '.join(cells)} |"


def table(model: type[Description], *, tagged: bool = False) -> str:
    """Return the table of the keys of a class."""
    said = {"kind": "Kind of this table.", **documented(model)}
    lines = ["| key | type | unit | default | allowed | meaning |", "|---|---|---|---|---|---|"]
    lines += [
        row(name, field, said[name], tag=tagged and name == "kind") for name, field in fields(model)
    ]
    return "\n".join(lines)


def what(model: type[Description]) -> str:
    """Return what a class says of itself, and its name."""
    return f"{summary(model)} Python: `carom.{model.__name__}`."


def title(model: type[Description]) -> str:
    """Return what tells a table of one kind from those of others."""
    if kind := model.model_fields.get("kind"):
        return f'`kind = "{kind.default}"`'
    return f"With `{next(name for name, field in fields(model) if field.is_required())}`"


def page() -> str:
    """Return the text of the page."""
    text = [HEAD, "## Top level\n", what(Scenario), "", table(Scenario), ""]
    written: dict[tuple[type[Description], ...], str] = {}
    for section in sections(Scenario):
        text.append(f"## `{section.header}`\n")
        if (before := written.setdefault(section.kinds, section.header)) != section.header:
            text.append(f"As `{before}`.\n")
            continue
        for model in section.kinds:
            tagged = len(section.kinds) > 1
            if tagged:
                text.append(f"### {title(model)}\n")
            text += [what(model), "", table(model, tagged=tagged), ""]
    return "\n".join([*text, CONDITIONS, RULES])


def schema() -> str:
    """Return the text of the schema."""
    return json.dumps(case_file_schema(), indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    sys.exit(write_or_check({PAGE: page(), SCHEMA: schema()}))
