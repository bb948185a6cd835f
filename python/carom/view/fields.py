"""What can be shown of a frame: one number per point or cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.io.frames import Frames
from carom.messages import known
from carom.results.field import ABOUT

UNITS = {
    **{name: unit for name, (_, unit) in ABOUT.items() if name != "stress"},
    "von-mises": "Pa",
    "hydrostatic-pressure": "Pa",
}
"""By the name of what is shown."""

TITLES = {
    "von-mises": "von Mises stress",
    "hydrostatic-pressure": "hydrostatic pressure",
    "velocity": "speed",
    "reaction": "contact reaction",
    "strain": "equivalent strain",
    "plastic_strain": "plastic strain",
    "energy_density": "strain energy density",
    "pressure": "contact pressure",
    "friction_energy": "friction energy",
    "slip": "distance slid",
}
"""What pictures and pages call it, where that is not its name."""

_OF_STRESS = ("von-mises", "hydrostatic-pressure")


@dataclass(frozen=True)
class Shown:
    """Something to show.

    Parameters
    ----------
    name
        What the user calls it.
    field
        The field it is made of.
    on_points
        Whether it has its values at points, else on cells.
    """

    name: str
    field: str
    on_points: bool

    @property
    def title(self) -> str:
        """What it is called in a picture, and its unit."""
        unit, what = UNITS.get(self.name, ""), TITLES.get(self.name, self.name)
        return f"{what} [{unit}]" if unit else what

    def values(self, frames: Frames, frame: int) -> NDArray[np.float64]:
        """Return one number per point or cell: of vectors and strains their size."""
        values = frames.field(self.field, frame)
        if values.ndim == 1 or values.shape[1] == 1:
            return values.reshape(-1)
        if self.name == "hydrostatic-pressure":
            return np.asarray(-values[:, :3].mean(axis=1))
        if values.shape[1] == 6:
            return _equivalent(values, factor=2 / 3 if self.name == "strain" else 3 / 2)
        return np.asarray(np.linalg.norm(values, axis=1))


def choices(frames: Frames) -> list[str]:
    """Return what can be shown of a file."""
    names: list[str] = []
    for name in frames.names:
        names += _OF_STRESS if name == "stress" else [name]
    return names


def shown(frames: Frames, name: str | None) -> Shown:
    """Return what a name stands for; None is the most telling that there is.

    Raises
    ------
    InputError
        The file has no such field.
    """
    names = choices(frames)
    if name is None:
        name = next(n for n in ("von-mises", "pressure", *names) if n in names)
    if name == "stress":
        name = "von-mises"
    if name not in names:
        raise InputError(f"--field {name}: no such field; {known(name, names)}")
    field = "stress" if name in _OF_STRESS else name
    return Shown(name, field, frames.is_on_points(field))


def _equivalent(tensor: NDArray[np.float64], *, factor: float) -> NDArray[np.float64]:
    """Return √(factor s:s) with s the deviator of xx yy zz xy yz xz: von Mises' equivalent."""
    normal, shear = tensor[:, :3], tensor[:, 3:]
    deviator = normal - normal.mean(axis=1, keepdims=True)
    return np.asarray(np.sqrt(factor * ((deviator**2).sum(axis=1) + 2 * (shear**2).sum(axis=1))))
