"""The stiffness of cells where nothing has moved."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, einsum
from carom.auditing.mesh.cells import Cells


def reference_stiffness(cells: Cells, lame: Array, shear: Array, *, dilates: bool) -> Array:
    """Return K₀ of cells [N/m], shape [cell_count, a, D, b, D]; all laws have Hooke's.

    Parameters
    ----------
    cells
        The cells.
    lame, shear
        λ and μ of each [Pa], shape [cell_count].
    dilates
        Whether each has one change of volume.
    """
    g, w = cells.gradients, cells.weights
    sheared = einsum("cq,cqaj,cqbj->cab", w, g, g)
    outer = einsum("cq,cqai,cqbk->caibk", w, g, g)
    crossed = outer.transpose(0, 1, 4, 3, 2)
    grown, hoops = g.copy(), np.zeros_like(outer)
    if cells.revolution:
        # Radial motion strains the hoops.
        grown[..., 0] += cells.hoops
        hoops[:, :, 0, :, 0] = 2.0 * einsum("cq,cqa,cqb->cab", w, cells.hoops, cells.hoops)
    isotropic = einsum("cab,ik->caibk", sheared, np.eye(cells.dimension))
    first, second = (m[:, None, None, None, None] for m in (lame, shear))
    stiffness: Array = second * (isotropic + crossed + hoops)
    outer = einsum("cq,cqai,cqbk->caibk", w, grown, grown)
    if not dilates:
        return np.asarray(stiffness + first * outer)
    # The change of volume is that of the cell: tr ε is its mean, but in dev ε.
    whole = w.sum(axis=1)[:, None, None, None, None]
    mean = einsum("cq,cqai->cai", w, grown)
    alike = einsum("cai,cbk->caibk", mean, mean) / whole
    return np.asarray(stiffness + (first + 2 / 3 * second) * alike - 2 / 3 * second * outer)
