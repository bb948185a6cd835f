"""How hard massless contact presses at the onset of an impact, by how deep the mass moves inside.

A bar of equal cells hits a rigid wall with its massless end. The force of the exact solution jumps
to ρcvA and stays there. That of the bar rises over a cell, and as the mass is all there, what it
lacks comes after: the deeper the mass of the end is spread, the lower is the peak, and the more do
the frequencies of the free bar suffer. Times are exact (modes), so nothing here is of a scheme.

    .venv/bin/python benchmarks/massless_onset.py [--cells 200]
"""

from __future__ import annotations

import argparse

import numpy as np
from scipy.linalg import eigh

LAYERS = (2, 3, 5, 8, 16, 32)
LATER = 5.0
"""Time after which what is left of the peak is told, in crossings of a cell by a wave."""


def bar(cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Return mass and stiffness of a bar of linear cells: h = ρA = EA = 1."""
    mass, stiffness = np.zeros((2, cells + 1, cells + 1))
    for first in range(cells):
        both = slice(first, first + 2)
        mass[both, both] += np.array([[2, 1], [1, 2]]) / 6
        stiffness[both, both] += np.array([[1, -1], [-1, 1]])
    return mass, stiffness


def spread(mass: np.ndarray, layers: int) -> np.ndarray:
    """Return the mass whose first node follows so many others by weights of least norm.

    They reproduce affine fields, as those of carom do, which takes five layers.
    """
    rows = np.vstack([np.ones(layers), np.arange(1, layers + 1)])
    weights = rows.T @ np.linalg.solve(rows @ rows.T, [1.0, 0.0])
    follow = np.eye(len(mass))
    follow[0, : layers + 1] = [0.0, *weights]
    moved: np.ndarray = follow.T @ mass @ follow
    return moved


def pressed(mass: np.ndarray, stiffness: np.ndarray) -> tuple[float, float]:
    """Return the largest force on the wall, of ρcvA, ever and later than `LATER`."""
    inside, held = mass[1:, 1:], stiffness[1:, 1:]
    squares, modes = eigh(held, inside)
    rates = np.sqrt(squares)
    shares = modes.T @ inside @ np.ones(len(inside)) / rates
    times = np.arange(0.0, 1.5 * len(inside), 0.05)
    force = modes[0] @ (shares[:, None] * np.sin(np.outer(rates, times)))
    return float(force.max()), float(force[times > LATER].max())


def first_frequency(mass: np.ndarray, stiffness: np.ndarray) -> float:
    """Return by how much the first frequency of the free bar is off."""
    inner = stiffness[1:, 1:] - np.outer(stiffness[1:, 0], stiffness[0, 1:]) / stiffness[0, 0]
    squares = eigh(inner, mass[1:, 1:], eigvals_only=True)
    return float(np.sqrt(squares[1]) * (len(mass) - 1) / np.pi - 1.0)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("--cells", type=int, default=200)
    cells = parser.parse_args().cells
    mass, stiffness = bar(cells)
    without = mass.copy()
    without[0, :] = without[:, 0] = 0.0
    peak, later = pressed(without, stiffness)
    print(f"{'layers':>8} {'peak':>7} {'later':>7} {'first frequency':>16}")
    print(f"{'lost':>8} {peak:7.4f} {later:7.4f} {'–':>16}")
    for layers in (n for n in LAYERS if n < cells):
        moved = spread(mass, layers)
        peak, later = pressed(moved, stiffness)
        print(f"{layers:8} {peak:7.4f} {later:7.4f} {first_frequency(moved, stiffness):16.1e}")


if __name__ == "__main__":
    main()
