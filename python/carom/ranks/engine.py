"""What a run needs of those who share its bodies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from carom._carom import thread_count
from carom.errors import InputError
from carom.system.threads import take_threads

T = TypeVar("T")

ENGINES = ("petsc",)
"""Their names."""


class Solver(Protocol):
    """Solves with a symmetric matrix of which every rank has a part."""

    @property
    def bytes(self) -> int:
        """Memory of this rank [bytes]."""

    def make(
        self,
        dimension: int,
        starts: NDArray[np.int64],
        columns: NDArray[np.uint32],
        values: NDArray[np.float64],
        exact: bool,
    ) -> bool:
        """Take the matrix; return whether it is positive definite.

        Parameters
        ----------
        dimension
            D, of the blocks.
        starts
            Where the entries of the row of every node start, and where the last ones end.
        columns
            The nodes of their columns.
        values
            Their blocks, each column by column, shape [entry_count D²].
        exact
            Whether solutions are to be exact but for round-off.
        """

    def solve(self, x: NDArray[np.float64]) -> None:
        """Replace a right-hand side of all nodes, shape [node_count D], by the solution."""


class Part(Protocol):
    """The share of a body that this rank has."""

    @property
    def owns(self) -> NDArray[np.bool_]:
        """Whether a cell is its own, by number."""

    @property
    def is_first(self) -> bool:
        """Whether it has what is to be counted once."""

    def sum(self, values: NDArray[np.float64] | NDArray[np.float32]) -> None:
        """Replace numbers by their sums over all ranks."""

    def solver(self) -> Solver:
        """Return what solves with matrices of the body."""


class Engine(Protocol):
    """The ranks of a run. All of them call the same methods in the same order."""

    @property
    def rank(self) -> int:
        """Number of this one, from 0."""

    @property
    def size(self) -> int:
        """How many there are."""

    @property
    def name(self) -> str:
        """What it is called in a case or a command."""

    def share(
        self, body: str, nodes: NDArray[np.float64], blocks: Sequence[NDArray[np.uint32]]
    ) -> Part | None:
        """Share a body; None if every rank is to have the whole of it, and to do the same.

        Parameters
        ----------
        body
            Its name.
        nodes
            Where its nodes are [m], shape [node_count, D].
        blocks
            The nodes of its cells, kind by kind, shape [cell_count, nodes of a cell].
        """

    def wait(self) -> None:
        """Wait until all are here."""

    def listening(self) -> AbstractContextManager[None]:
        """Hold Ctrl-C and SIGTERM back within the block until all ranks `look`."""

    def look(self) -> None:
        """Raise what any rank was told: `KeyboardInterrupt`, of Ctrl-C, or `Terminated`."""

    def all_failed(self) -> bool:
        """Return whether all ranks have come to this place, within a short time."""

    def abort(self, status: int) -> None:
        """End the processes of all ranks."""


def in_turn(engine: Engine | None, look: Callable[[], T]) -> T:
    """Return what every rank sees once the first one has looked, which may change what there is."""
    if engine is None:
        return look()
    if engine.rank > 0:
        engine.wait()
        return look()
    seen = look()
    engine.wait()
    return seen


def engine_named(name: str) -> Engine:
    """Return the engine of this name; this process has one thread from then on.

    Raises
    ------
    InputError
        There is none, or what it needs is not installed.
    """
    if name not in ENGINES:
        raise InputError(f"engine {name}: no such engine; choose one of {', '.join(ENGINES)}")
    # Bodies that threads share would be summed over ranks in an order that no two ranks have alike.
    take_threads(1)
    count = thread_count()
    if count > 1:
        raise InputError(
            f"engine {name}: this process has {count} threads by now, and a rank has one; "
            "start it with RAYON_NUM_THREADS=1"
        )
    from carom.ranks.petsc import PetscEngine  # noqa: PLC0415 (MPI starts as it is imported)

    return PetscEngine()
