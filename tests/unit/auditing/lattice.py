"""A code of another's in a few lines: masses joined by bars, in the plane or in space."""

from itertools import combinations, product

import numpy as np

import carom

SIDES = {
    2: [[0, 1], [1, 3], [3, 2], [2, 0]],
    3: [[0, 2, 6, 4], [1, 5, 7, 3], [0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6]],
}
CELLS = {2: {"quad": [[0, 2, 3, 1]]}, 3: {"hexahedron": [[0, 4, 6, 2, 1, 5, 7, 3]]}}


class Lattice:
    """A square or a cube of one metre: its corners are joined by bars, and may be by springs.

    The springs, of `anchor` [N/m], hold all corners to where they are drawn.
    """

    def __init__(self, corner, stiffness=1000.0, anchor=0.0):
        self.points = np.array(list(product([0.0, 1.0], repeat=len(corner)))) + corner
        self.ends = np.array(list(combinations(range(len(self.points)), 2))).T
        self.stiff, self.anchor = stiffness, anchor
        self.rest = self._bars(0.0 * self.points)[1]

    def _bars(self, u):
        x = self.points + u.reshape(self.points.shape)
        along = x[self.ends[1]] - x[self.ends[0]]
        length = np.linalg.norm(along, axis=1)
        return along / length[:, None], length

    def energy(self, u):
        longer = self._bars(u)[1] - self.rest
        return 0.5 * self.stiff * longer @ longer + 0.5 * self.anchor * u @ u

    def force(self, u):
        along, length = self._bars(u)
        pull = self.stiff * (length - self.rest)[:, None] * along
        out = self.anchor * u.reshape(self.points.shape)
        np.add.at(out, self.ends[1], pull)
        np.add.at(out, self.ends[0], -pull)
        return out.ravel()

    def stiffness(self, u):
        """Without what tension adds: it may be approximate."""
        out = self.anchor * np.eye(u.size)
        axes = np.eye(u.size).reshape(*self.points.shape, u.size)
        for a, b, along in zip(*self.ends, self._bars(u)[0], strict=True):
            row = along @ (axes[b] - axes[a])
            out += self.stiff * np.outer(row, row)
        return out

    def body(self, name, **given):
        """Return it as a body, of 1 kg at every corner."""
        dimension = self.points.shape[1]
        arguments = {
            "mass": np.eye(self.points.size),
            "energy": self.energy,
            "force": self.force,
            "stiffness": self.stiffness,
            "cells": CELLS[dimension],
        }
        return carom.ForeignBody(name, self.points, SIDES[dimension], **(arguments | given))
