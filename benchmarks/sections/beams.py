"""Impacts on beams: the energy of every mode."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import sphere_on_beam
import timoshenko

import carom
from sections.layout import percent, power, signed, table

BENDING = 5
"""Modes of bending whose shares are told."""

CLAMPED: dict[str, Any] = {"divisions": 3, "clamped": True}

STRIKES: tuple[tuple[str, dict[str, Any]], ...] = (
    ("free, middle, 2 cells", {"divisions": 2}),
    ("free, middle, 3 cells", {"divisions": 3}),
    ("free, middle, 4 cells", {"divisions": 4}),
    ("free, middle, 3 cells, 0.1 m/s", {"divisions": 3, "speed": 0.1}),
    ("free, a quarter from the end, 3 cells", {"divisions": 3, "at": -0.25}),
    ("clamped, middle, 3 cells", CLAMPED),
)
"""What the rows are called and how they are computed; `at` in lengths of the beam."""

NOTHING = 5e-5
"""A share that is told as none."""

STEPS, COARSE = 40, 5e-3
"""Steps in the time of Hertz's contact; from node to node of the beam [m]."""

REDUCED = (10, 20, 30, 60)
"""Modes of the beam as a reduced body."""

BEAMS = """\
## A sphere on a beam

A steel sphere of radius {radius:.0f} mm strikes a beam of steel, {length:.0f} × {width:.0f} ×
{height:.0f} mm, at {speed:g} m/s, and `carom.modal_energies` reads the energy of every mode when
it has left (`tests/validation/sphere_on_beam.py`). Both are meshed in space, half or a quarter of
them where there are planes of symmetry; `massless` contact, Δt a {steps}th of the time of Hertz's
contact.

The theory is Timoshenko's of 1913: Hertz's law between a mass and the modes of a beam, here one
with shear and rotary inertia, of which it takes 50 (`tests/validation/timoshenko.py`, Ritz's
method and `scipy.integrate.solve_ivp`). The tests know its limits: frequencies in closed form, e =
1 where the beam is held, Boussinesq's integral for an endless beam. The mass of the sphere is that
of its mesh.

What is told are the rebound, the speed of the sphere after over that before, and shares of the
energy before: of the motion of the beam as a whole and of its first five modes of bending. In
brackets is by how much carom is off the theory. Cells are those over 1.4 radii of the contact.

{table}

Frequencies are off Timoshenko's by at most {frequencies}, by {clamped} where the ends are clamped.
The largest force is off by {forces} from the coarsest to the finest mesh. Rigid motion, modes,
rest and sphere add up to the energy before to {closes} of it; the defect of the ledger is at most
{defect} E₀.

The whole beam as a reduced body, struck at its middle, two cells: the third mode of bending is not
among the first 10 with the patch held, and with 20 all is there. Asserted in
`test_sphere_on_beam.py`; that the vibrations of a reduced body have all of its energy, in
`test_modal_energies.py`.

{reduced}

Gehr, Theurich, Monjaraz-Tec, Gross, Schwarz, Hartung & Krack (arXiv:2207.00795) have measured this
kind of impact. Their measurements are not compared here.
"""


def beams_section() -> str:
    """Let the sphere strike beams, whole and reduced."""
    rows, strikes = [], []
    for name, given in STRIKES:
        found, theory = _struck(**given)
        strikes.append((found, theory))
        rows.append((name, *_beside(found, theory)))
        print(f"         {name}", flush=True)
    reduced = []
    for modes in REDUCED:
        found, theory = _struck(divisions=2, modes=modes)
        strikes.append((found, theory))
        reduced.append((modes, *_beside(found, theory)))
        print(f"         {modes} modes", flush=True)
    reduced.append(("whole", *rows[0][1:]))
    header = ("rebound", "rigid", *(f"mode {k}" for k in range(1, BENDING + 1)))
    whole = [pair for pair, (_, given) in zip(strikes, STRIKES, strict=False) if given != CLAMPED]
    return BEAMS.format(
        radius=1e3 * sphere_on_beam.RADIUS,
        length=1e3 * sphere_on_beam.BEAM.length,
        width=1e3 * sphere_on_beam.BEAM.width,
        height=1e3 * sphere_on_beam.BEAM.height,
        speed=1.0,
        steps=STEPS,
        frequencies=percent(max(map(_detuned, whole)), 1),
        clamped=percent(_detuned(strikes[len(STRIKES) - 1]), 1),
        table=table(("beam", *header), rows),
        reduced=table(("modes", *header), reduced),
        forces=" to ".join(map(_harder, (strikes[0], strikes[2]))),
        closes=power(max(found.closes for found, _ in strikes)),
        defect=power(max(found.defect for found, _ in strikes)),
    )


def _struck(
    *, at: float = 0.0, speed: float = 1.0, clamped: bool = False, **given: Any
) -> tuple[sphere_on_beam.Strike, timoshenko.Theory]:
    """Return an impact by carom and by theory."""
    beam = replace(sphere_on_beam.BEAM, supports="clamped" if clamped else "free")
    place = at * beam.length
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", carom.CaromWarning)
        found = sphere_on_beam.strike(
            at=place, speed=speed, steps=STEPS, coarse=COARSE, clamped=clamped, **given
        )
    theory = timoshenko.strike(
        beam.modes(50),
        at=place,
        mass=found.mass,
        speed=speed,
        stiffness=sphere_on_beam.STIFFNESS,
        longest=1e-3,
    )
    return found, theory


def _beside(found: sphere_on_beam.Strike, theory: timoshenko.Theory) -> list[str]:
    """Return what carom found, and in brackets by how much that is off the theory."""
    shares = found.of_bending(theory.frequencies[:BENDING])
    pairs = [
        (found.rebound, theory.rebound),
        (found.rigid, theory.rigid),
        *zip(shares.tolist(), theory.shares.tolist(), strict=False),
    ]
    return [
        f"{signed(a, 4)} ({signed(a - b, 4)})" if max(abs(a), abs(b)) > NOTHING else "0"
        for a, b in pairs
    ]


def _detuned(pair: tuple[sphere_on_beam.Strike, timoshenko.Theory]) -> float:
    """Return by how much frequencies of modes that were struck are off, relative to the theory."""
    found, theory = pair
    struck = [k for k in range(BENDING) if theory.shares[k] > 1e-4]
    return max(float(abs(found.frequencies / theory.frequencies[k] - 1.0).min()) for k in struck)


def _harder(pair: tuple[sphere_on_beam.Strike, timoshenko.Theory]) -> str:
    found, theory = pair
    return percent(found.force / theory.force - 1.0, 1)
