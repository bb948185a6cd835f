"""The energy of a body over time, by its modes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ModalEnergies:
    """The energy of a body over time, by its modes.

    ``rigid``, the modes and the two rests add up to its kinetic and strain energy. The rests are
    what modes that were not asked for have, and what a strain that is not small has beside ½ ω² η².

    Parameters
    ----------
    body
        Its name.
    times
        Times of the frames [s], shape [frame_count].
    frequencies
        Of its modes [Hz], shape [count], the slowest first.
    rigid
        Kinetic energy of its translation and rotation [J], shape [frame_count]; of a body on
        supports that of what these leave it to do without strain.
    kinetic, strain
        ½ η̇² and ½ ω² η² of its modes [J], shape [frame_count, count].
    rest_kinetic, rest_strain
        What is left of both [J], shape [frame_count].
    """

    body: str
    times: Array
    frequencies: Array
    rigid: Array
    kinetic: Array
    strain: Array
    rest_kinetic: Array
    rest_strain: Array

    @property
    def energies(self) -> Array:
        """Kinetic and strain energy of the modes [J], shape [frame_count, count]."""
        return self.kinetic + self.strain

    @property
    def rest(self) -> Array:
        """What neither a mode nor ``rigid`` has [J], shape [frame_count]."""
        return self.rest_kinetic + self.rest_strain

    @property
    def total(self) -> Array:
        """Kinetic and strain energy of the body [J], shape [frame_count]."""
        total: Array = self.rigid + self.energies.sum(axis=1) + self.rest
        return total
