"""Arrays from outside: numbers of the right shape, all finite, or a message that says where not."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from carom.errors import InputError


def numbers(name: str, values: ArrayLike, *, finite: bool = True) -> NDArray[np.float64]:
    """Return values as an array of numbers of its own, which must be finite unless said else."""
    if np.iscomplexobj(values):
        raise InputError(f"{name}: has complex numbers; must be real", name)
    try:
        array = np.array(values, dtype=np.float64, order="C")
    except (TypeError, ValueError):
        raise InputError(f"{name}: must be an array of numbers", name) from None
    if finite:
        _refuse_infinite(name, array)
    return array


def sizes(name: str, values: ArrayLike, mu: ArrayLike) -> tuple[int, int]:
    """Return the numbers of contacts and of components that vectors and μ speak of."""
    shape, mu_shape = np.shape(values), np.shape(mu)
    if len(shape) == 2:
        contacts, dimension = shape
    elif len(shape) == 1 and len(mu_shape) == 1:
        (entries,), (contacts,) = shape, mu_shape
        dimension = entries // contacts if contacts else 3
        if entries != contacts * dimension:
            raise InputError(
                f"{name} has {entries} entries for the {contacts} contacts of mu: must be 1, 2 or "
                "3 for each",
                name,
            )
    else:
        raise InputError(
            f"{name} has shape {shown(shape)} and mu {shown(mu_shape)}: {name} must be [n, D], or "
            "[n D] with n coefficients in mu",
            name,
        )
    if dimension not in {1, 2, 3}:
        raise InputError(
            f"{name} has {dimension} components for each of {contacts} contacts: must be 1, 2 or 3",
            name,
        )
    return contacts, dimension


def vectors(
    name: str, values: ArrayLike, *, contacts: int, dimension: int, finite: bool = True
) -> NDArray[np.float64]:
    """Return one vector per contact, shape [contacts, dimension], from that shape or a flat one."""
    array = numbers(name, values, finite=finite)
    if array.shape not in {(contacts, dimension), (contacts * dimension,)}:
        raise InputError(
            f"{name} has shape {shown(array.shape)}: must be [{contacts}, {dimension}] or "
            f"[{contacts * dimension}], {dimension} components for each of {contacts} contacts",
            name,
        )
    return array.reshape(contacts, dimension)


def coefficients(values: ArrayLike, *, contacts: int) -> NDArray[np.float64]:
    """Return the friction coefficients, shape [contacts], from that shape or one number for all."""
    array = numbers("mu", values)
    if array.ndim == 0:
        array = np.full(contacts, float(array))
    if array.shape != (contacts,):
        raise InputError(
            f"mu has shape {shown(array.shape)}: must be [{contacts}], one coefficient for each "
            "contact",
            "mu",
        )
    if (wrong := np.flatnonzero(array < 0.0)).size:
        where = int(wrong[0])
        raise InputError(f"mu[{where}] = {array[where]:g}: must be at least 0", "mu")
    return array


def matrix(name: str, values: Any) -> sp.csr_array:  # noqa: ANN401 (NumPy or any scipy.sparse)
    """Return a matrix of finite numbers in compressed rows, columns ascending, none repeated."""
    if not sp.issparse(values):
        values = numbers(name, values)
    if values.ndim != 2:
        raise InputError(f"{name} has shape {shown(values.shape)}: must be a matrix", name)
    if np.iscomplexobj(values):
        raise InputError(f"{name}: has complex numbers; must be real", name)
    rows = sp.csr_array(values, dtype=np.float64)
    if rows is values:
        rows = rows.copy()
    rows.sum_duplicates()
    if not np.isfinite(rows.data).all():
        entry = int(np.flatnonzero(~np.isfinite(rows.data))[0])
        row, column = place(rows, entry)
        raise InputError(f"{name}[{row}, {column}] = {rows.data[entry]}: must be finite", name)
    return rows


def place(rows: sp.csr_array, entry: int) -> tuple[int, int]:
    """Return row and column of a stored entry."""
    return int(np.searchsorted(rows.indptr, entry, side="right")) - 1, int(rows.indices[entry])


def _refuse_infinite(name: str, array: NDArray[np.float64]) -> None:
    """Raise at the first number that is not finite."""
    if np.isfinite(array).all():
        return
    where = np.argwhere(~np.isfinite(array))[0]
    index = f"[{', '.join(map(str, where))}]" if where.size else ""
    raise InputError(f"{name}{index} = {array[tuple(where)]}: must be finite", name)


def shown(shape: tuple[int, ...]) -> str:
    """Return a shape as it is written in messages and docstrings."""
    return f"[{', '.join(map(str, shape))}]"
