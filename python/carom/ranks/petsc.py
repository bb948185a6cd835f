"""Ranks by MPI, and what they solve by PETSc: mpi4py and petsc4py."""

from __future__ import annotations

import ctypes
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_matrix

from carom.ranks.needed import MPI, PETSc
from carom.ranks.partition import ranks_of_cells, ranks_of_nodes
from carom.system.interrupt import Terminated

PATIENCE = 3.0
"""How long one that has failed waits for the others to fail, too [s]."""

SHARED = 5000
"""Unknowns from which a body is shared: a smaller one is done with before ranks have agreed."""

FACTORED = {2: 2_000_000, 3: 60_000}
"""Unknowns up to which a body is factorised, by dimension: by nested dissection a factor has
n log n values in the plane and n^(4/3) in space."""

TOLERANCE = {True: 1e-13, False: 1e-8}
"""What conjugate gradients leave of a right-hand side, where solutions are to be exact and not."""

MUMPS = {13: 1, 24: 1}
"""Its controls: a root that one rank factorises, and pivots that are seen to be zero, so that the
signs of all are known."""

ITERATIONS = 1000
"""The most of conjugate gradients."""

MALLOPT = {-1: 2**23, -3: 2**22, -4: 2**16}
"""`M_TRIM_THRESHOLD`, `M_MMAP_THRESHOLD` [bytes] and `M_MMAP_MAX` of glibc. What messages are
summed in is less, and is not asked of the system again for every one."""


def give_memory_back() -> None:
    """Have memory that is freed go back to the system, as Linux does it.

    PETSc as Debian builds it turns that off as it is imported. A rank then keeps what it takes only
    while bodies are built and matrices are made: as much again as a quarter of what it needs.
    """
    if sys.platform == "linux":
        mallopt = getattr(ctypes.CDLL(None), "mallopt", lambda *_: 0)
        for option, value in MALLOPT.items():
            mallopt(option, value)


class PetscEngine:
    """The ranks of the communicator of all processes of a run."""

    name = "petsc"

    def __init__(self) -> None:
        give_memory_back()
        self._comm = MPI.COMM_WORLD
        # What a rank that has failed waits in must not be mixed up with what the others do.
        self._failing = self._comm.Dup()
        self._told = 0

    @property
    def rank(self) -> int:
        """Number of this one, from 0."""
        return int(self._comm.rank)

    @property
    def size(self) -> int:
        """How many there are."""
        return int(self._comm.size)

    def share(
        self, body: str, nodes: NDArray[np.float64], blocks: Sequence[NDArray[np.uint32]]
    ) -> PetscPart | None:
        """Share a body; see `Engine.share`."""
        if nodes.size < SHARED:
            return None
        return PetscPart(self._comm, nodes, blocks)

    def wait(self) -> None:
        """Wait until all are here."""
        self._comm.Barrier()

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Hold Ctrl-C and SIGTERM back within the block until all ranks `look`."""

        def note(number: int, _: object) -> None:
            self._told = max(self._told, number)

        kinds = (signal.SIGINT, signal.SIGTERM)
        before = [signal.signal(kind, note) for kind in kinds]
        try:
            yield
        finally:
            for kind, handler in zip(kinds, before, strict=True):
                signal.signal(kind, handler)

    def look(self) -> None:
        """Raise what any rank was told: `KeyboardInterrupt`, of Ctrl-C, or `Terminated`."""
        told = self._comm.allreduce(self._told, MPI.MAX)
        if told == signal.SIGTERM:
            raise Terminated
        if told != 0:
            raise KeyboardInterrupt

    def all_failed(self) -> bool:
        """Return whether all ranks have come to this place, within a short time."""
        request = self._failing.Ibarrier()
        end = time.monotonic() + PATIENCE
        while not request.Test():
            if time.monotonic() > end:
                return False
            time.sleep(0.01)
        return True

    def abort(self, status: int) -> None:
        """End the processes of all ranks."""
        self._comm.Abort(status)


class PetscPart:
    """The share of a body that this rank has; see `Part`.

    Its nodes are numbered anew for PETSc, whose ranks have rows that follow one another: rank by
    rank, and as they were within a rank.
    """

    def __init__(
        self,
        comm: MPI.Comm,
        nodes: NDArray[np.float64],
        blocks: Sequence[NDArray[np.uint32]],
    ) -> None:
        cells = ranks_of_cells(nodes, blocks, comm.size)
        of_nodes = ranks_of_nodes(len(nodes), blocks, cells)
        self.comm, self.nodes = comm, nodes
        self.owns: NDArray[np.bool_] = cells == comm.rank
        self.is_first = comm.rank == 0
        self.order = np.argsort(of_nodes, kind="stable")
        self.number = np.empty(len(nodes), dtype=np.int32)
        self.number[self.order] = np.arange(len(nodes), dtype=np.int32)
        self.counts = np.bincount(of_nodes, minlength=comm.size)
        first = int(self.counts[: comm.rank].sum())
        self.own = self.order[first : first + int(self.counts[comm.rank])]
        touched = [block[own] for block, own in zip(blocks, self._by_block(blocks), strict=True)]
        self.local = np.unique(np.concatenate([cells.ravel() for cells in touched]))

    def _by_block(self, blocks: Sequence[NDArray[np.uint32]]) -> list[NDArray[np.bool_]]:
        ends = np.cumsum([len(block) for block in blocks])[:-1]
        return np.split(self.owns, ends)

    def sum(self, values: NDArray[np.float64] | NDArray[np.float32]) -> None:
        """Replace numbers by their sums over all ranks."""
        self.comm.Allreduce(MPI.IN_PLACE, values)

    def solver(self) -> PetscSolver:
        """Return what solves with matrices of the body."""
        return PetscSolver(self)


class PetscSolver:
    """A factor of MUMPS where that is small enough, else conjugate gradients with multigrid.

    The options of PETSc that start with ``carom_`` change it, as ``-carom_pc_type hypre`` does in
    ``PETSC_OPTIONS``.
    """

    def __init__(self, part: PetscPart) -> None:
        self._part = part
        self._solver: Any = None
        self.bytes = 0

    def make(
        self,
        dimension: int,
        starts: NDArray[np.int64],
        columns: NDArray[np.uint32],
        values: NDArray[np.float64],
        exact: bool,
    ) -> bool:
        """Take the matrix; see `Solver.make`."""
        self._forget()
        matrix = self._matrix(dimension, starts, columns, values)
        self._dimension = dimension
        self._x, self._b = matrix.createVecs()
        solver = PETSc.KSP().create(self._part.comm)
        solver.setOptionsPrefix("carom_")
        preconditioner = solver.getPC()
        is_factored = matrix.size[0] <= FACTORED[dimension]
        if is_factored:
            solver.setType("preonly")
            preconditioner.setType("cholesky")
            preconditioner.setFactorSolverType("mumps")
            solver.setOperators(matrix)
            preconditioner.setFactorSetUpSolverType()
            factor = preconditioner.getFactorMatrix()
            for control, choice in MUMPS.items():
                factor.setMumpsIcntl(control, choice)
        else:
            solver.setType("cg")
            solver.setTolerances(rtol=TOLERANCE[exact], atol=1e-300, max_it=ITERATIONS)
            preconditioner.setType("gamg")
            matrix.setNearNullSpace(self._rigid_motions(dimension))
        solver.setOperators(matrix)
        solver.setFromOptions()
        self._solver = solver
        self.bytes = int(matrix.getInfo()["memory"])
        try:
            solver.setUp()
        except PETSc.Error:
            return False
        if solver.getType() == "preonly":
            return self._has_no_negative(preconditioner)
        return self._is_definite()

    def _matrix(
        self,
        dimension: int,
        starts: NDArray[np.int64],
        columns: NDArray[np.uint32],
        values: NDArray[np.float64],
    ) -> PETSc.Mat:
        """Return the sum of the parts of all ranks, over the nodes as PETSc numbers them."""
        part, d = self._part, dimension
        # What no cell of this rank has is an empty diagonal block.
        place = np.full(len(part.nodes), -1, dtype=np.int32)
        place[part.local] = np.arange(len(part.local), dtype=np.int32)
        rows = np.repeat(np.arange(len(part.nodes)), np.diff(starts))
        blocks = values.reshape(-1, d, d).transpose(0, 2, 1)
        has = (place[rows] >= 0) & (place[columns] >= 0)
        if not has.all() and np.any(blocks[~has]):
            # Springs of supports and of nodes without mass: where others have the cells.
            extra = np.unique(rows[~has & blocks.any(axis=(1, 2))])
            local = np.union1d(part.local, extra)
            place[local] = np.arange(len(local), dtype=np.int32)
            has = (place[rows] >= 0) & (place[columns] >= 0)
        else:
            local = part.local
        at, beside, blocks = place[rows[has]], place[columns[has]], blocks[has]
        order = np.lexsort((beside, at))
        ends = np.searchsorted(at[order], np.arange(len(local) + 1))
        size = d * len(local)
        own = bsr_matrix((blocks[order], beside[order], ends), shape=(size, size)).tocsr()
        numbering = PETSc.LGMap().create(part.number[local], bsize=d, comm=part.comm)
        sizes = (d * len(part.own), d * len(part.nodes))
        whole = PETSc.Mat().createIS((sizes, sizes), numbering, numbering, comm=part.comm)
        csr = (own.indptr.astype(np.int32), own.indices.astype(np.int32), own.data)
        inner = PETSc.Mat().createAIJ((size, size), csr=csr, comm=PETSc.COMM_SELF)
        inner.setBlockSize(d)
        whole.setISLocalMat(inner)
        whole.assemble()
        matrix = whole.convert("aij", PETSc.Mat())
        matrix.setBlockSize(d)
        matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        whole.destroy()
        inner.destroy()
        return matrix

    def _rigid_motions(self, dimension: int) -> PETSc.NullSpace:
        """Return the motions that cost a free body no energy, which multigrid has to know."""
        part = self._part
        places = PETSc.Vec().create(part.comm)
        places.setSizes((dimension * len(part.own), dimension * len(part.nodes)), dimension)
        places.setUp()
        places.array[:] = part.nodes[part.own].ravel()
        return PETSc.NullSpace().createRigidBody(places)

    def _has_no_negative(self, preconditioner: PETSc.PC) -> bool:
        """Return whether no eigenvalue is negative, which the signs of the factor say."""
        return bool(preconditioner.getFactorMatrix().getInertia()[0] == 0)

    def _is_definite(self) -> bool:
        """Return whether conjugate gradients meet no direction that is not positive."""
        random = np.random.default_rng(1)
        self._b.array[:] = random.standard_normal(len(self._b.array))
        self._solver.solve(self._b, self._x)
        indefinite = (
            PETSc.KSP.ConvergedReason.DIVERGED_INDEFINITE_MAT,
            PETSc.KSP.ConvergedReason.DIVERGED_INDEFINITE_PC,
            PETSc.KSP.ConvergedReason.DIVERGED_NANORINF,
        )
        return self._solver.getConvergedReason() not in indefinite

    def solve(self, x: NDArray[np.float64]) -> None:
        """Replace a right-hand side of all nodes, shape [node_count D], by the solution."""
        part, d = self._part, self._dimension
        rows = x.reshape(-1, d)
        self._b.array[:] = rows[part.own].ravel()
        self._solver.solve(self._b, self._x)
        everyone = np.empty_like(rows)
        part.comm.Allgatherv(self._x.array, (everyone, d * part.counts))
        rows[part.order] = everyone

    def _forget(self) -> None:
        """Give back what PETSc has of the last matrix."""
        if self._solver is not None:
            matrix, _ = self._solver.getOperators()
            for one in (self._solver, matrix, self._x, self._b):
                one.destroy()
            self._solver = None
