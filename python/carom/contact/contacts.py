"""What takes part in a step, as plain arrays."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

if TYPE_CHECKING:
    from carom.contact.model import ContactModel


@dataclass(frozen=True, eq=False)
class Candidates:
    """What a search has found and takes part in the step, for `ContactModel.evaluate`.

    Parameters
    ----------
    count
        How many there are.
    number
        Which search of the model it was: an older one is of no use any more.
    """

    count: int
    number: int

    def __len__(self) -> int:
        return self.count


@dataclass(frozen=True, eq=False, repr=False)
class Contacts:
    """The contacts that take part in a step, evaluated at a guess of its motion d.

    The relative motion of a contact, w = Hᵀ d + offset, has component 0 along its normal. The laws
    of contact and friction hold between w and its reaction r, and H r are the forces on your
    unknowns.

    Parameters
    ----------
    pair
        The names of the two that may touch there, shape [n].
    node
        Your number of the source node; -1 of contacts between nodes, shape [n].
    gap
        Distance along the normal [m], negative where there is penetration, where the condition is
        written; shape [n].
    frame
        Rows normal, from target to source, and tangents, shape [n, D, D].
    friction
        Coulomb's coefficient, shape [n].
    offset
        What w has beside Hᵀ d [m]: what the condition makes of the gap, and prescribed motion.
        Shape [n, D].
    guess
        Reactions as they are known so far [N], shape [n, D].
    starts, nodes, weights
        The stencils in compressed rows: your nodes of contact i and their weights are those from
        starts[i] to starts[i + 1]. The weights of either side sum to ±1.
    """

    pair: tuple[tuple[str, str], ...]
    node: NDArray[np.int64]
    gap: NDArray[np.float64]
    frame: NDArray[np.float64]
    friction: NDArray[np.float64]
    offset: NDArray[np.float64]
    guess: NDArray[np.float64]
    starts: NDArray[np.int64]
    nodes: NDArray[np.int64]
    weights: NDArray[np.float64]
    _model: ContactModel = field(repr=False)
    _number: int = field(repr=False)

    def __len__(self) -> int:
        return len(self.gap)

    def __repr__(self) -> str:
        least = f", least gap {self.gap.min():.3g} m" if len(self) else ""
        return f"<Contacts: {len(self)}{least}>"

    @cached_property
    def H(self) -> sp.csc_array:  # noqa: N802 (the field's notation)
        """Map from reactions to the forces on your unknowns, shape [dof_count, n D].

        What is prescribed has no row: its motion is part of the offset.
        """
        dofs, count = self._model.dofs, self._model.dof_count
        dimension = dofs.shape[1]
        owner = np.repeat(np.arange(len(self)), np.diff(self.starts))
        # One entry per node of a stencil, component of its motion and row of the frame.
        shape = (len(owner), dimension, dimension)
        rows = np.broadcast_to(dofs[self.nodes][:, :, None], shape)
        columns = owner[:, None, None] * dimension + np.arange(dimension)
        columns = np.broadcast_to(columns, shape)
        values = self.weights[:, None, None] * self.frame[owner].transpose(0, 2, 1)
        free = rows >= 0
        entries = (values[free], (rows[free], columns[free]))
        return sp.csc_array(entries, shape=(count, len(self) * dimension))
