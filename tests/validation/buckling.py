"""Where a block of compressible rubber that is squeezed between smooth plates buckles.

Of u = f(X) cos(kY), v = g(X) sin(kY), k = n π/H, the second variation of the energy of a block of
the height H is a quadratic form in f and g (Hill 1957; for waves of a surface Biot 1963). The block
is stable as long as it is positive for every n. Here f and g are polynomials in X, of a degree
beyond which nothing changes; no finite elements take part.
"""

from functools import cache

import numpy as np
from numpy.polynomial import legendre

DEGREE = 24
WAVES = 8
"""Of shorter waves the surface alone knows, and all of them the same."""


def _across(mu: float, lame: float, along: float) -> float:
    """Return the stretch that leaves the sides of a block free of stress."""
    low, high = 0.5, 5.0
    for _ in range(100):
        x = 0.5 * (low + high)
        pull = mu * (x - 1.0 / x) + lame * np.log(x * along) / x
        low, high = (x, high) if pull < 0.0 else (low, x)
    return 0.5 * (low + high)


NODES, WEIGHT = legendre.leggauss(2 * DEGREE)
"""Of the quadrature across the block, from −1 to 1."""


@cache
def _basis(parity: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the polynomials that are even (0) or odd (1), and their derivatives, at the nodes."""
    coefficients = np.eye(DEGREE + 1)[parity::2]
    value = np.array([legendre.legval(NODES, c) for c in coefficients])
    return value, np.array([legendre.legval(NODES, legendre.legder(c)) for c in coefficients])


def _least(
    poisson: float, compression: float, slenderness: float, waves: int, is_odd: bool
) -> float:
    """Return the least eigenvalue of the form, f odd in X or even, for a width of 2a, k a given."""
    mu, lame = 0.5 / (1.0 + poisson), poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    y = 1.0 - compression
    x = _across(mu, lame, y)
    turned = mu - lame * np.log(x * y)
    along, across = mu + (lame + turned) / y**2, mu + (lame + turned) / x**2
    mixed, shear = lame / (x * y), turned / (x * y)
    k = waves * np.pi * slenderness

    (f, df), (g, dg) = _basis(1 if is_odd else 0), _basis(0 if is_odd else 1)
    ff = across * (df * WEIGHT) @ df.T + mu * k**2 * (f * WEIGHT) @ f.T
    gg = along * k**2 * (g * WEIGHT) @ g.T + mu * (dg * WEIGHT) @ dg.T
    fg = k * (mixed * (df * WEIGHT) @ g.T - shear * (f * WEIGHT) @ dg.T)
    form = np.block([[ff, fg], [fg.T, gg]])
    size = np.sqrt(np.diag(np.abs(form)))
    return float(np.linalg.eigvalsh(form / np.outer(size, size))[0])


def critical_compression(poisson: float, width: float, height: float, *, is_guided: bool) -> float:
    """Return the compression at which a block buckles, 1 − h/H.

    A block that is guided at one side is half of one that moves the same at both. Without a guide
    the other half of all motions takes part, as those of a column that gives way to a side.
    """
    half = width if is_guided else 0.5 * width
    kinds = [(n, True) for n in range(1, WAVES + 1)]
    if not is_guided:
        kinds += [(n, False) for n in range(1, WAVES + 1)]

    def is_stable(compression: float) -> bool:
        slenderness = half / height
        return all(_least(poisson, compression, slenderness, n, odd) > 0.0 for n, odd in kinds)

    low, high = 0.0, 0.7
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_stable(middle) else (low, middle)
    return 0.5 * (low + high)
