"""An engine of one rank without MPI: all that the core asks of ranks, with a factor of SciPy."""

from contextlib import contextmanager

import numpy as np
import scipy.sparse
import scipy.sparse.linalg


class OneRank:
    """Has all cells of all bodies, and counts what it is asked to sum."""

    name, rank, size = "one", 0, 1

    def __init__(self):
        self.summed = 0

    def share(self, body, nodes, blocks):
        return Part(self, len(nodes), sum(len(cells) for cells in blocks))

    def wait(self):
        pass

    @contextmanager
    def listening(self):
        yield

    def look(self):
        pass


class Part:
    is_first = True

    def __init__(self, engine, nodes, cells):
        self._engine, self._nodes = engine, nodes
        self.owns = np.ones(cells, dtype=bool)

    def sum(self, values):
        assert values.flags.writeable
        self._engine.summed += 1

    def solver(self):
        return Solver(self._nodes)


class Solver:
    bytes = 0

    def __init__(self, nodes):
        self._nodes = nodes

    def make(self, dimension, starts, columns, values, exact):
        blocks = values.reshape(-1, dimension, dimension).transpose(0, 2, 1)
        size = dimension * self._nodes
        matrix = scipy.sparse.bsr_matrix((blocks, columns, starts), shape=(size, size)).tocsc()
        self._factor = scipy.sparse.linalg.splu(matrix)
        return bool(np.all(self._factor.U.diagonal() > 0.0))

    def solve(self, x):
        x[:] = self._factor.solve(x.copy())
