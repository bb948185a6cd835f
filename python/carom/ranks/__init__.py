"""Runs on more than one machine: processes that share the cells of bodies.

Each of the processes, ranks in the words of MPI, has some of the cells of every deformable body and
all of its nodes. What is a sum over cells is summed over the ranks, what is solved for is solved by
all of them, and everything else each does for itself, with the same numbers. The first one writes
the results.
"""

from carom.ranks.engine import Engine, engine_named

__all__ = ["Engine", "engine_named"]
