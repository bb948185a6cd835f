"""What meshio 5.3 does not read of Gmsh's format 4.1, mended while it reads.

It asks of every entity that it has exactly one physical group. Those without, which a file saved
with all its entities has, then leave too few numbers of groups, and two are no truth value.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def any_number_of_groups() -> Iterator[None]:
    """Let meshio read entities of no physical group, as group 0, and of several."""
    from meshio.gmsh import _gmsh41  # noqa: PLC0415 (only cases with mesh files need it)

    read = _gmsh41._read_entities

    def mended(*arguments: Any) -> Any:  # noqa: ANN401 (meshio has no types)
        groups, bounds = read(*arguments)
        return tuple({e: [*map(int, g)] or [0] for e, g in of.items()} for of in groups), bounds

    _gmsh41._read_entities = mended
    try:
        yield
    finally:
        _gmsh41._read_entities = read
