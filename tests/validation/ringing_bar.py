"""A bar hits one of twice its length, which rings: the case, and the energies of its modes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from runs import Array

import carom

SPEED, WAVES, HEIGHT = 0.1, 100.0, 0.5  # m/s, m/s, m
LONG = 2.0  # m; the other bar is half as long


def bars(cells: int, condition: str = "massless") -> carom.Scenario:
    """Return the case with so many cells along the long bar."""
    return carom.Scenario.from_dict(
        {
            "analysis": {
                "end_time": 0.06,
                "time_step": 0.5 * LONG / cells / WAVES,
                "scheme": {"kind": "conserving"},
            },
            "output": {"history_every": 0.01, "fields_every": 0.01},
            "materials": {
                "steel": {
                    "kind": "linear-elastic",
                    "young": WAVES**2,
                    "poisson": 0.0,
                    "density": 1.0,
                }
            },
            "bodies": [
                {
                    "name": name,
                    "material": "steel",
                    "mesh": {
                        "kind": "rectangle",
                        "corner": [corner, 0.0],
                        "size": [length, HEIGHT],
                        "divisions": [round(cells * length / LONG), 1],
                    },
                    "velocity": [speed, 0.0],
                    "contact_sets": [side],
                }
                for name, corner, length, speed, side in (
                    ("short", -LONG / 2, LONG / 2, SPEED, "right"),
                    ("long", 0.0, LONG, 0.0, "left"),
                )
            ],
            "contact": {"condition": condition},
        }
    )


def recorded(result: carom.Result, body: str) -> Array:
    """Return kinetic and strain energy of a body in the history [J]."""
    parts = ("translation", "rotation", "vibration", "strain")
    total: Array = sum(result.history[f"{body}.{part}"] for part in parts)
    return total


NUMBERS = np.array([1, 2, 3])
"""Of the modes along the bar that are looked at."""

EXACT = np.where(NUMBERS % 2, 8.0 / (np.pi * NUMBERS) ** 2, 0.0)
"""Their shares of the energy m v²/8 that rings."""


@dataclass(frozen=True)
class Ringing:
    """The long bar after the impact.

    Parameters
    ----------
    frequencies
        Of the modes of `NUMBERS` [Hz].
    shares
        Their mean shares of the energy that rings.
    change
        The largest change of a share.
    off
        The largest error of the sum over all parts, relative to the energy at the start.
    restitution
        Of the impact: ½, the ratio of the lengths.
    """

    frequencies: Array
    shares: Array
    change: float
    off: float
    restitution: float


def ringing(cells: int, out: Path) -> Ringing:
    """Run the case and look at the long bar after the impact."""
    result = carom.run(bars(cells), out=out)
    energies = carom.modal_energies(result, count=60, bodies=["long"])["long"]
    off = abs(energies.total - recorded(result, "long")).max()
    first = WAVES / (2 * LONG)
    found = [int(abs(energies.frequencies - n * first).argmin()) for n in NUMBERS]
    late = energies.times > 1.25 * LONG / WAVES
    shares = energies.energies[late][:, found] / (LONG * HEIGHT * SPEED**2 / 8.0)
    return Ringing(
        frequencies=energies.frequencies[found],
        shares=shares.mean(axis=0),
        change=float(np.ptp(shares, axis=0).max()),
        off=float(off / result.summary["energy"]["initial"]),
        restitution=result.summary["contacts"][0]["impact"]["restitution"],
    )
