"""What carom's contact costs beside the code that it is planted in: the discs of scikit-fem.

    .venv/bin/python benchmarks/planted_share.py [end time]

Prints the processor time of the loop of examples/scikit_fem_discs.py, how much of it is carom's
(search, evaluation, the contact problem, the books, without the solver that it calls), and how much
is scikit-fem's assembly and the factors.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from time import process_time
from typing import Any

from carom import contact

sys.path.insert(0, str(Path(__file__).parents[1] / "examples"))

import scikit_fem_discs as example

TAKEN: Counter[str] = Counter()


def timed(name: str, call: Callable[..., Any]) -> Callable[..., Any]:
    """Return the same function, whose time is that of `name`."""

    def wrapped(*args: Any, **given: Any) -> Any:
        start = process_time()
        try:
            return call(*args, **given)
        finally:
            TAKEN[name] += process_time() - start

    return wrapped


def main(end_time: float = 0.6) -> None:
    """Run the loop with a clock in what it calls."""
    discs = example.Discs()
    for name in ("force", "stiffness"):
        setattr(discs, name, timed("assembly", getattr(discs, name)))
    for name in ("search", "evaluate", "missed", "accept"):
        setattr(contact.ContactModel, name, timed("carom", getattr(contact.ContactModel, name)))
    solve, factor = contact.solve, timed("factors", example.splu)

    def solved(contacts: Any, solver: Any, **given: Any) -> Any:
        return solve(contacts, timed("solver", solver), **given)

    contact.solve = timed("carom", solved)
    example.splu = factor
    start = process_time()
    run = example.collide(discs, end_time)
    took = process_time() - start
    own, assembly = TAKEN["carom"] - TAKEN["solver"], TAKEN["assembly"]
    factors = TAKEN["factors"] + TAKEN["solver"]
    print(
        f"{run.iterations} iterations in {took:.1f} s: carom {own / took:.1%}, assembly "
        f"{assembly / took:.1%}, factors and their solutions {factors / took:.1%}; carom takes "
        f"{own / assembly:.1%} of the time of the assembly"
    )


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
