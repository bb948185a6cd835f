"""A steel sphere strikes a beam of steel: what its bending takes, by Timoshenko and by carom.

The beam is meshed in space, ever finer towards where it is struck, and with it the sphere. What
carom finds of the energy of each mode is compared with `timoshenko.strike`. Such an impact was
measured by Gehr, Theurich, Monjaraz-Tec, Gross, Schwarz, Hartung & Krack (arXiv:2207.00795).
"""

from __future__ import annotations

import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from abaqus_file import written
from runs import EXAMPLES, Array
from timoshenko import Beam
from zener import graded

import carom

sys.path.insert(0, str(EXAMPLES))
from graded_sphere import GradedSphere

RADIUS, DENSITY, YOUNG, POISSON = 0.008, 7800.0, 210e9, 0.3
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
STIFFNESS = 4 / 3 * math.sqrt(RADIUS) * YOUNG / (2 * (1 - POISSON**2))
"""K of two bodies of steel [N/m^(3/2)]."""

BEAM = Beam(0.15, 0.01, 0.012, YOUNG, POISSON, DENSITY)

GROWTH = 2.0
"""Of the cells of the beam away from where it is struck."""

LASTS = 1.5
"""Time that is computed, over that of Hertz's contact."""

COUNT = 25
"""Modes of the beam whose energy is asked for, along its width and of torsion among them."""

NEAR = 0.04
"""What the frequency of a mode in space may be off that of a beam."""


def hertz(speed: float) -> tuple[float, float]:
    """Return the time of contact [s] and its radius [m] on a beam that does not yield."""
    depth = (5 * MASS * speed**2 / (4 * STIFFNESS)) ** 0.4
    return 2.9432 * depth / speed, math.sqrt(RADIUS * depth)


_CORNERS = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2)]
_EDGES = [(1, 0, 0), (2, 1, 0), (1, 2, 0), (0, 1, 0), (1, 0, 2), (2, 1, 2), (1, 2, 2), (0, 1, 2)]
_UPRIGHT = [(0, 0, 1), (2, 0, 1), (2, 2, 1), (0, 2, 1)]
_MIDDLES = [(1, 1, 1), (1, 1, 0), (1, 1, 2), (1, 0, 1), (2, 1, 1), (1, 2, 1), (0, 1, 1)]
NODES = np.array([*_CORNERS, *_EDGES, *_UPRIGHT, *_MIDDLES])
"""Nodes of C3D27, in halves of the cell."""

MIDDLE = 20


def beam(file: Path, *, at: float, cell: float, patch: float, coarse: float, whole: bool) -> Path:
    """Write the beam below z = 0, struck at the origin, as an Abaqus input file.

    Cells are of second order: those of first order are much too stiff where they bend.

    Parameters
    ----------
    at
        Where it is struck, from its middle [m]. At the middle half of its length is meshed.
    cell
        From node to node where these are closest [m].
    patch
        How far from the origin that is so [m].
    coarse
        From node to node along the others [m].
    whole
        Whether all of it is meshed, or a part with planes of symmetry, ``x`` and ``y``.
    """

    def places(size: float) -> Array:
        corners = graded(2 * cell, patch, 2 * coarse, size, growth=GROWTH)
        middles = 0.5 * (corners[1:] + corners[:-1])
        return np.sort(np.concatenate([corners, middles]))

    x, y, z = places(0.5 * BEAM.length - at), places(0.5 * BEAM.width), -places(BEAM.height)[::-1]
    if at != 0.0 or whole:
        x = np.concatenate([-places(0.5 * BEAM.length + at)[:0:-1], x])
    if whole:
        y = np.concatenate([-y[:0:-1], y])
    points = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
    shape = (len(x), len(y), len(z))
    number = np.arange(len(points)).reshape(shape)
    each = [
        tuple(slice(k, n - 2 + k, 2) for k, n in zip(node, shape, strict=True)) for node in NODES
    ]
    cells = np.stack([number[of_node].ravel() for of_node in each], axis=-1)
    centres = points[cells[:, MIDDLE]]
    top = (centres[:, 2] > -1.1 * cell) & (np.abs(centres[:, :2]) < patch).all(axis=1)
    ends = np.isin(points[:, 0], x[-1:] if x[0] == 0.0 else x[[0, -1]])
    on = {"x": points[:, 0] == 0.0, "y": points[:, 1] == 0.0, "ends": ends}
    return written(
        file,
        points,
        cells,
        kind="C3D27",
        name="beam",
        surfaces={"patch": [f"{e + 1}, S2" for e in np.flatnonzero(top)]},
        sets={name: np.flatnonzero(where) for name, where in on.items()},
    )


@dataclass(frozen=True)
class Strike:
    """What came of an impact.

    Parameters
    ----------
    mass
        Of the meshed sphere [kg], which is a little less than that of a round one.
    rebound
        Speed of the sphere away from the beam after, over that before.
    frequencies
        Of the modes of the beam [Hz].
    shares
        Their energy after, over that before.
    rigid, rest
        That of the beam's motion without strain, and of modes that were not asked for.
    force
        The largest [N].
    defect
        Largest defect of the ledger, relative to the energy at the start.
    closes
        By how much the energies of sphere and modes are off that at the start, relative to it.
    """

    mass: float
    rebound: float
    frequencies: Array
    shares: Array
    rigid: float
    rest: float
    force: float
    defect: float
    closes: float

    def of_bending(self, frequencies: Array) -> Array:
        """Return the shares of modes of these frequencies [Hz].

        Modes that are not of bending along the height have nothing, be they near or not.
        """
        near = np.abs(self.frequencies[None, :] / frequencies[:, None] - 1.0) < NEAR
        shares: Array = near @ self.shares
        return shares


def strike(
    *,
    at: float,
    speed: float,
    divisions: int,
    steps: int,
    coarse: float,
    clamped: bool = False,
    modes: int | None = None,
    condition: str = "massless",
) -> Strike:
    """Let the sphere strike the beam.

    Parameters
    ----------
    at
        Where, from the middle [m].
    speed
        Of the sphere [m/s].
    divisions
        Cells along 1.4 times the radius of the contact, of both bodies.
    steps
        Steps in the time of Hertz's contact.
    coarse
        From node to node along the beam far from the contact [m].
    clamped
        Whether the ends of the beam are held, which else are free.
    modes
        Of the beam as a reduced body; None for a whole one, of which a half or a quarter is meshed.
    condition
        Of the contact.
    """
    duration, contact = hertz(speed)
    patch = 1.4 * contact
    sphere = GradedSphere.make(RADIUS, patch=patch, divisions=divisions, dimension=3, growth=1.5)
    planes = [] if modes is not None else ["y"] if at else ["x", "y"]
    for axis, name in enumerate("xy"):
        if name not in planes:
            sphere = sphere.mirrored(axis)
    parts = 1 << len(planes)
    with tempfile.TemporaryDirectory() as folder:
        files = {
            "sphere": sphere.write(Path(folder) / "sphere.inp"),
            "beam": beam(
                Path(folder) / "beam.inp",
                at=at,
                cell=patch / divisions,
                patch=patch,
                coarse=coarse,
                whole=modes is not None,
            ),
        }
        given = {
            "name": "beam",
            "material": "steel",
            "mesh": carom.MeshFile(file=str(files["beam"])),
            "contact_sets": ["patch"],
        }
        case = carom.Scenario(
            title="Sphere on a beam",
            dimension=3,
            analysis=carom.Dynamic(
                end_time=LASTS * duration,
                time_step=duration / steps,
                scheme=carom.Conserving(),
            ),
            output=carom.Output(history_every=duration / steps, fields_every=LASTS * duration),
            materials={"steel": carom.LinearElastic(young=YOUNG, poisson=POISSON, density=DENSITY)},
            bodies=[
                carom.Body(
                    name="sphere",
                    material="steel",
                    mesh=carom.MeshFile(file=str(files["sphere"])),
                    velocity=[0.0, 0.0, -speed],
                ),
                carom.Body(**given) if modes is None else carom.ReducedBody(modes=modes, **given),
            ],
            motions=[
                *(
                    carom.Fixed(body=name, on=axis, components=[axis])
                    for name in files
                    for axis in planes
                ),
                *([carom.Fixed(body="beam", on="ends", components=["x", "z"])] * clamped),
            ],
            contact=carom.Contact(condition=condition),
        )
        result = carom.run(case, out=Path(folder) / "results")
        history, energy = result.history, result.summary["energy"]
        assert history["normal_force"][-1] == 0.0, "the sphere is still there"
        energies = carom.modal_energies(result, count=COUNT, bodies=["beam"])["beam"]
    initial = energy["initial"]
    of_sphere = sum(
        history[f"sphere.{part}"][-1] for part in ("translation", "rotation", "vibration", "strain")
    )
    return Strike(
        mass=float(2.0 * parts * initial / speed**2),
        rebound=float(history["sphere.v_z"][-1] / speed),
        frequencies=energies.frequencies,
        shares=energies.energies[-1] / initial,
        rigid=float(energies.rigid[-1] / initial),
        rest=float(energies.rest[-1] / initial),
        force=parts * float(history["normal_force"].max()),
        defect=float(np.abs(history["defect"]).max() / initial),
        closes=float(abs((energies.total[-1] + of_sphere) / initial - 1.0)),
    )
