"""A sphere strikes a beam, in theory: Hertz's law and the vibrations of Timoshenko's beam.

Timoshenko (Z. Math. Phys. 62 (1913) 198; Goldsmith, Impact (1960), ch. 4): the sphere is a mass,
the beam a sum of modes, and between them is Hertz's F = K s^(3/2), s how far they have approached:

    m ẍ = −F,  η̈_k + ω_k² η_k = φ_k F,  s = x − Σ φ_k η_k.

The modes are those of a beam with shear and rotary inertia (κ of Cowper, J. Appl. Mech. 33 (1966)),
by Ritz's method with Legendre's polynomials, which finds low ones to round-off. Nothing of this is
carom's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre
from runs import Array
from scipy.integrate import solve_ivp
from scipy.linalg import eigh, null_space

DEGREE = 80
"""Of the polynomials."""

RIGID = 1e-5
"""What is slower than this, in terms of the sixth mode, moves without strain."""


@dataclass(frozen=True)
class Beam:
    """A beam with a rectangular section.

    Parameters
    ----------
    length, height, width
        Sizes [m]; it bends along its height.
    young, poisson, density
        Its material [Pa, –, kg/m³].
    supports
        Of both ends: ``free``, ``pinned`` or ``clamped``.
    """

    length: float
    height: float
    width: float
    young: float
    poisson: float
    density: float
    supports: str = "free"

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.density * self.length * self.height * self.width

    def modes(self, count: int) -> Modes:
        """Return the slowest modes, motions without strain among them."""
        area, second = self.height * self.width, self.width * self.height**3 / 12.0
        shear = self.young / (2.0 * (1.0 + self.poisson)) * area
        shear *= 10.0 * (1.0 + self.poisson) / (12.0 + 11.0 * self.poisson)
        places, weights = legendre.leggauss(DEGREE + 2)
        half = 0.5 * self.length
        value, slope = _polynomials(places), _slopes(places) / half
        weights = half * weights[:, None]
        mass = value.T @ (weights * value)
        bent, mixed = slope.T @ (weights * slope), slope.T @ (weights * value)
        none = np.zeros_like(mass)
        inertia = self.density * np.block([[area * mass, none], [none, second * mass]])
        stiffness = np.block(
            [
                [shear * bent, -shear * mixed],
                [-shear * mixed.T, self.young * second * bent + shear * mass],
            ]
        )
        ends = _polynomials(np.array([-1.0, 1.0]))
        nothing = np.zeros_like(ends)
        held = {
            "free": np.zeros((0, 2 * (DEGREE + 1))),
            "pinned": np.block([ends, nothing]),
            "clamped": np.block([[ends, nothing], [nothing, ends]]),
        }[self.supports]
        left = null_space(held) if len(held) else np.eye(2 * (DEGREE + 1))
        squares, shapes = eigh(left.T @ stiffness @ left, left.T @ inertia @ left)
        frequencies = np.sqrt(np.maximum(squares, 0.0))
        frequencies[frequencies < RIGID * frequencies[5]] = 0.0
        return Modes(half, frequencies[:count], (left @ shapes)[: DEGREE + 1, :count])


@dataclass(frozen=True)
class Modes:
    """Modes of a beam with ∫ ρA φ² + ρI ψ² = 1.

    Parameters
    ----------
    half
        Half of its length [m].
    frequencies
        ω [rad/s], shape [count].
    shapes
        Polynomials of the deflections φ [kg^-½], shape [degree + 1, count].
    """

    half: float
    frequencies: Array
    shapes: Array

    def at(self, place: float) -> Array:
        """Return φ at a place from the middle [m], shape [count]."""
        found: Array = _polynomials(np.array([place / self.half]))[0] @ self.shapes
        return found


@dataclass(frozen=True)
class Theory:
    """What comes of an impact.

    Parameters
    ----------
    duration
        Until the sphere leaves [s].
    force
        The largest [N].
    rebound
        Speed of the sphere away from the beam after, over that before.
    frequencies
        Of the modes that vibrate [Hz].
    shares
        Their energy after, over that of the sphere before.
    rigid
        That of motions without strain.
    defect
        By how much all of this is off the energy before, relative to that.
    """

    duration: float
    force: float
    rebound: float
    frequencies: Array
    shares: Array
    rigid: float
    defect: float


def strike(
    modes: Modes, *, at: float, mass: float, speed: float, stiffness: float, longest: float
) -> Theory:
    """Let a sphere strike the beam.

    Parameters
    ----------
    modes
        Of the beam.
    at
        Where, from the middle [m].
    mass, speed
        Of the sphere [kg, m/s].
    stiffness
        K of Hertz's law [N/m^(3/2)].
    longest
        Time in which it leaves [s].
    """
    omega, phi = modes.frequencies, modes.at(at)
    count = len(omega)

    def approach(state: Array) -> float:
        return float(state[0] - phi @ state[2 : 2 + count])

    def rate(_: float, state: Array) -> Array:
        force = stiffness * max(approach(state), 0.0) ** 1.5
        pushed = phi * force - omega**2 * state[2 : 2 + count]
        return np.concatenate([[state[1], -force / mass], state[2 + count :], pushed])

    def leaves(_: float, state: Array) -> float:
        return approach(state)

    leaves.terminal, leaves.direction = True, -1.0  # type: ignore[attr-defined]
    start = np.zeros(2 + 2 * count)
    start[1] = speed
    path = solve_ivp(
        rate, (0.0, longest), start, method="DOP853", events=leaves, rtol=1e-12, atol=1e-17
    )
    if path.status != 1:
        raise RuntimeError(f"the sphere is still there after {longest} s")
    energy = 0.5 * mass * speed**2
    end = path.y[:, -1]
    each = 0.5 * (end[2 + count :] ** 2 + (omega * end[2 : 2 + count]) ** 2) / energy
    depths = np.array([approach(state) for state in path.y.T])
    bends = omega > 0.0
    return Theory(
        duration=float(path.t[-1]),
        force=float(stiffness * depths.max() ** 1.5),
        rebound=float(-end[1] / speed),
        frequencies=omega[bends] / (2.0 * math.pi),
        shares=each[bends],
        rigid=float(each[~bends].sum()),
        defect=float(abs((end[1] / speed) ** 2 + each.sum() - 1.0)),
    )


def rebound_from_endless(
    *, line: float, bending: float, mass: float, speed: float, stiffness: float, steps: int
) -> float:
    """Return the rebound from an endless beam without shear and rotary inertia.

    An impulse 1 gives the point it acts on the speed 1/(2μ √(2π c t)), c = √(EI/μ) (Boussinesq),
    the sum of all its waves; so F gives it the deflection ∫ F(t') √(t − t') dt'/(μ √(2π c)).

    Parameters
    ----------
    line
        μ, mass by length [kg/m].
    bending
        EI [N m²].
    mass, speed, stiffness
        Of the sphere, and of Hertz's law.
    steps
        In the time of Hertz's contact with what does not yield.
    """
    depth = (5.0 * mass * speed**2 / (4.0 * stiffness)) ** 0.4
    step = 2.9432 * depth / speed / steps
    yields = 1.0 / (line * math.sqrt(2.0 * math.pi * math.sqrt(bending / line)))
    # Forces are constant from half a step before to half a step after they are known.
    edges = step * (np.arange(20 * steps) + 0.5)
    weights = np.diff(edges**1.5) * 2.0 / 3.0
    forces = np.zeros(len(weights))
    place, rate = 0.0, speed
    for known in range(1, len(weights)):
        rate -= step * forces[known - 1] / mass
        place += step * rate
        approach = place - yields * float(forces[:known] @ weights[known - 1 :: -1])
        if approach <= 0.0:
            return -rate / speed
        forces[known] = stiffness * approach**1.5
    raise RuntimeError(f"the sphere is still there after {len(weights)} steps")


def _polynomials(places: Array) -> Array:
    """Values of Legendre's polynomials, ∫ P² = 1, shape [place_count, degree + 1]."""
    values: Array = legendre.legvander(places, DEGREE) * _norms()
    return values


def _slopes(places: Array) -> Array:
    columns = [legendre.legval(places, legendre.legder(row)) for row in np.diag(_norms())]
    return np.stack(columns, axis=1)


def _norms() -> Array:
    norms: Array = np.sqrt(np.arange(DEGREE + 1) + 0.5)
    return norms
