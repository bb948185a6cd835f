"""A shaft in a hub, fitted in three ways; shared by the tests and ``benchmarks/press_fit.py``."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Literal

from runs import simulate

import carom

YOUNG, POISSON = 210e9, 0.3
RADIUS, OUTER = 0.02, 0.04  # m
LENGTH = 0.02  # m, of the fit of bodies of revolution
DELTA = 20e-6  # m
FRICTION = 0.1
SLIDE = 20e-6  # m

Way = Literal["interference", "overlap", "growth"]
Discretisation = Literal["node-to-segment", "mortar"]

WAYS: tuple[Way, ...] = ("interference", "overlap", "growth")
DISCRETISATIONS: tuple[Discretisation, ...] = ("node-to-segment", "mortar")


@dataclass(frozen=True)
class Fit:
    """What a fit gave.

    Parameters
    ----------
    force
        Normal force, or that which pulls the shaft out [N].
    exact
        The same by Lamé.
    history
        The last row of the history by title.
    """

    force: float
    exact: float
    history: dict[str, float]

    @property
    def error(self) -> float:
        """How much the force is off."""
        return self.force / self.exact - 1.0


def lame(length: float) -> float:
    """Return the normal force [N] between a shaft and a hub of one steel, held along the axis.

    In a theory of small displacements it does not matter which of the two is drawn too large: the
    force on the shaft per radian is that on the hub.
    """
    stiffness = YOUNG / (1.0 - POISSON**2)
    pressure = stiffness * DELTA * (OUTER**2 - RADIUS**2) / (2.0 * RADIUS * OUTER**2)
    return pressure * 2.0 * pi * RADIUS * length


def _radius(way: Way) -> float:
    """Return the radius of the shaft as it is drawn."""
    return RADIUS + DELTA if way == "overlap" else RADIUS


def _growth(way: Way) -> str | None:
    """Return what makes the shaft thicker by DELTA: growth that is held along goes across."""
    return f"{DELTA / RADIUS / (1.0 + POISSON)}*min(t, 1)" if way == "growth" else None


def _contact(way: Way, discretisation: Discretisation, friction: float) -> carom.Contact:
    if way == "interference":
        pair = carom.Pair(between=("shaft", "hub"), interference=f"{DELTA}*min(t, 1)")
        return carom.Contact(friction=friction, discretisation=discretisation, pairs=(pair,))
    if way == "overlap":
        return carom.Contact(
            friction=friction,
            discretisation=discretisation,
            resolve_overlap=True,
            overlap_resolved_at=1.0,
        )
    return carom.Contact(friction=friction, discretisation=discretisation)


def free_to_turn(
    cell: str, discretisation: Discretisation, facets: tuple[int, int] = (32, 48)
) -> carom.Scenario:
    """Return the fit of a slice that nothing supports, without friction.

    The shaft and the hub have so many `facets` around.
    """
    steel = carom.NeoHookean(young=YOUNG, poisson=POISSON, density=7800.0)
    divisions = facets[0] // 4
    rings = {} if divisions % 2 == 0 else {"rings": max(2, divisions // 2)}
    shaft = carom.Disc(centre=(0.0, 0.0), radius=RADIUS, divisions=divisions, cell=cell, **rings)
    hub = carom.Ring(
        centre=(0.0, 0.0),
        inner_radius=RADIUS,
        outer_radius=OUTER,
        divisions=(facets[1], 8),
        cell=cell,
    )
    return carom.Scenario(
        analysis=carom.Static(end_time=1.0, time_step=0.25),
        materials={"steel": steel},
        bodies=[
            carom.Body(name=name, material="steel", mesh=mesh)
            for name, mesh in (("shaft", shaft), ("hub", hub))
        ],
        contact=_contact("interference", discretisation, 0.0),
    )


STEEL = carom.LinearElastic(young=YOUNG, poisson=POISSON, density=7800.0)


def fit(shape: str, way: Way, discretisation: Discretisation, divisions: int) -> Fit:
    """Fit a slice of a long shaft, or a body of revolution between two plates."""
    if shape == "slice":
        # Unequal facets: their chords are apart by more than the interference.
        around = divisions * 6
        shaft = carom.Body(
            name="shaft",
            material="steel",
            mesh=carom.Disc(centre=(0.0, 0.0), radius=_radius(way), divisions=divisions),
            growth=_growth(way),
        )
        ring = carom.Ring(
            centre=(0.0, 0.0),
            inner_radius=RADIUS,
            outer_radius=OUTER,
            divisions=(around, divisions),
        )
        bodies = (shaft, carom.Body(name="hub", material="steel", mesh=ring))
        motions: tuple[carom.Fixed, ...] = ()
        length = 1.0
    else:
        bodies = _revolved(way, divisions)
        held = [(body, on) for body in ("shaft", "hub") for on in ("bottom", "top")]
        motions = tuple(carom.Fixed(body=b, on=on, components=("y",)) for b, on in held)
        length = LENGTH
    scenario = carom.Scenario(
        analysis=carom.Static(end_time=1.0, time_step=0.25),
        materials={"steel": STEEL},
        bodies=bodies,
        motions=motions,
        contact=_contact(way, discretisation, 0.0),
    )
    last = _last_row(scenario)
    return Fit(last["normal_force"], lame(length), last)


def pull(way: Way, discretisation: Discretisation, divisions: int) -> Fit:
    """Fit a body of revolution and pull it out a little, once it slides all along."""
    held = [carom.Fixed(body="hub", on=on, components=("y",)) for on in ("bottom", "top")]
    along = f"{SLIDE}*max(t - 1, 0)"
    pulled = [carom.Prescribed(body="shaft", on=on, y=along) for on in ("bottom", "top")]
    scenario = carom.Scenario(
        analysis=carom.Static(end_time=2.0, time_step=0.125),
        materials={"steel": STEEL},
        bodies=_revolved(way, divisions),
        motions=(*held, *pulled),
        contact=_contact(way, discretisation, FRICTION),
    )
    last = _last_row(scenario)
    force = last["shaft.bottom.force_y"] + last["shaft.top.force_y"]
    return Fit(force, FRICTION * lame(LENGTH), last)


def _revolved(way: Way, divisions: int) -> tuple[carom.Body, carom.Body]:
    radius = _radius(way)

    def body(name: str, corner: float, width: float, layers: int) -> carom.Body:
        mesh = carom.Rectangle(
            corner=(corner, 0.0), size=(width, LENGTH), divisions=(divisions, layers)
        )
        growth = _growth(way) if name == "shaft" else None
        return carom.Body(
            name=name, material="steel", hypothesis="axisymmetric", mesh=mesh, growth=growth
        )

    hub = body("hub", RADIUS, OUTER - RADIUS, divisions + 1)
    return body("shaft", 0.0, radius, divisions), hub


def _last_row(scenario: carom.Scenario) -> dict[str, float]:
    """Run a case and return the last row of its history."""
    run = simulate(scenario)
    return {title: float(column[-1]) for title, column in run.history.items()}
