"""What meets what, when, and how far apart it is at the start."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from carom.doctor.finding import Finding
from carom.doctor.flight import REFINEMENTS, SAMPLES, Flight, body_gap, obstacle_gap
from carom.doctor.patient import Patient
from carom.motion import Fixed
from carom.scenario import Scenario
from carom.signal import Signal
from carom.travel import travel, values

Led = Mapping[int, Callable[[float], float]]
"""By axis, the displacement that is prescribed [m] over time [s]."""


def meeting(patient: Patient) -> Iterator[Finding]:
    """Say the initial gaps and, where bodies fly or are led, when the first two touch."""
    pairs = patient.description["pairs"]
    if not pairs:
        yield Finding(
            "warning",
            "contact",
            "nothing can touch anything: there is one body and no obstacle, or no pair is enabled",
            "add an obstacle or a second body, or enable a pair in contact.pairs",
        )
        return
    nearest = min(pairs, key=lambda pair: pair["initial_gap"])
    yield Finding(
        "ok",
        "bodies",
        f"no overlap at the start; the nearest are {_names(nearest)}, "
        f"{nearest['initial_gap']:.4g} m apart at {_place(nearest['at'])}",
    )
    scenario = patient.scenario
    if not patient.is_dynamic:
        return
    loaded = {load.body for load in scenario.loads}
    led = {body.name: _led(scenario, body.name) for body in scenario.bodies}
    unknown = loaded | {name for name, by_axis in led.items() if by_axis is None}
    foreseen = [pair for pair in pairs if not unknown.intersection(pair["between"])]
    foreseen = [pair for pair in foreseen if len(set(pair["between"])) == 2]
    flights = {
        body.name: flight
        for body, flight in zip(scenario.bodies, _flights(patient, led), strict=True)
    }
    yield from _first_touch(patient, foreseen, flights, others=len(pairs) - len(foreseen))


def _led(scenario: Scenario, body: str) -> Led | None:
    """Return what supports of a body prescribe by axis; None if they do not move as one."""
    signals: dict[int, Signal] = {}
    for motion in scenario.motions:
        if motion.body != body:
            continue
        for axis, name in enumerate("xyz"[: scenario.dimension]):
            signal: Signal | None
            if isinstance(motion, Fixed):
                signal = 0.0 if name in (motion.components or "xyz") else None
            else:
                signal = getattr(motion, name)
            if signal is not None and signals.setdefault(axis, signal) != signal:
                return None
    return {axis: _displacement(signal) for axis, signal in signals.items()}


def _displacement(signal: Signal) -> Callable[[float], float]:
    return lambda time: float(values(signal, np.array([time]))[0])


def _first_touch(
    patient: Patient,
    pairs: list[dict[str, Any]],
    flights: Mapping[str, Flight],
    *,
    others: int,
) -> Iterator[Finding]:
    """Say which of the pairs touches first, as if bodies were rigid."""
    end = patient.scenario.analysis.end_time
    times, closest = [], []
    for pair in pairs:
        if (gap := _gap_over_time(patient, pair, flights)) is None:
            others += 1
            continue
        time, least = _touch(gap, end, tolerance=_tolerance(patient, pair))
        times.append((time, pair))
        closest.append((least, pair))
    touching = [(time, pair) for time, pair in times if time is not None]
    if touching:
        time, pair = min(touching, key=lambda entry: entry[0])
        yield Finding(
            "ok",
            "analysis.end_time",
            f"the first to touch are {_names(pair)}, at about {time:.3g} s of {end:g} s",
        )
    elif closest and not others:
        least, pair = min(closest, key=lambda entry: entry[0])
        yield Finding(
            "warning",
            "analysis.end_time",
            f"nothing meets until the end at {end:g} s; the nearest are {_names(pair)}, "
            f"{max(least, 0.0):.3g} m apart at the least",
            "take a later end_time, or check velocities, gravity and positions",
        )
    elif closest:
        yield Finding(
            "ok",
            "analysis.end_time",
            "nothing that is foreseen meets; what loads drive, or supports that move apart, is not "
            "foreseen",
        )


def _flights(patient: Patient, led: Mapping[str, Led | None]) -> Iterator[Flight]:
    scenario, dimension = patient.scenario, patient.scenario.dimension
    gravity = np.asarray(scenario.analysis.gravity or [0.0] * dimension, dtype=float)
    for body, boundary, grid in zip(
        scenario.bodies, patient.boundaries, patient.grids, strict=True
    ):
        spin: Any = (0.0 if dimension == 2 else [0.0] * 3) if body.spin is None else body.spin
        yield Flight(
            boundary,
            centre=grid.points.mean(axis=0),
            velocity=np.asarray(body.velocity or [0.0] * dimension, dtype=float),
            gravity=gravity,
            spin=np.asarray(spin, dtype=float),
            led=led[body.name] or {},
        )


def _gap_over_time(
    patient: Patient, pair: Mapping[str, Any], flights: Mapping[str, Flight]
) -> Callable[[float], float] | None:
    obstacles = {obstacle.name: obstacle for obstacle in patient.scenario.obstacles}
    one, other = pair["between"]
    if one in obstacles:
        one, other = other, one
    flight = flights[one]
    if other not in obstacles:
        return lambda time: body_gap(flight.at(time), flights[other].at(time))
    obstacle, dimension = obstacles[other], patient.scenario.dimension
    if obstacle_gap(obstacle, flight.points) is None:
        return None

    def gap(time: float) -> float:
        moved = travel(obstacle, np.array([time]), dimension=dimension)[0]
        return obstacle_gap(obstacle, flight.at(time) - moved) or 0.0

    return gap


def _tolerance(patient: Patient, pair: Mapping[str, Any]) -> float:
    """Return below which distance of points two count as touching [m]: half the shortest edge."""
    edges = {b["name"]: float(b["smallest_edge"]) for b in patient.description["bodies"]}
    of_pair = [edges[name] for name in pair["between"] if name in edges]
    return 0.5 * max(of_pair) if len(of_pair) == 2 else 1e-9 * of_pair[0]


def _touch(
    gap: Callable[[float], float], end: float, *, tolerance: float
) -> tuple[float | None, float]:
    """Return when a gap closes, None if it does not, and the least that was seen of it [m]."""
    before, least = 0.0, np.inf
    for time in np.linspace(0.0, end, SAMPLES + 1):
        least = min(least, distance := gap(float(time)))
        if distance <= tolerance:
            low, high = before, float(time)
            for _ in range(REFINEMENTS):
                middle = 0.5 * (low + high)
                low, high = (low, middle) if gap(middle) <= tolerance else (middle, high)
            return high, least
        before = float(time)
    return None, float(least)


def _names(pair: Mapping[str, Any]) -> str:
    return " and ".join(pair["between"])


def _place(at: list[float]) -> str:
    return f"({', '.join(f'{x:.4g}' for x in at)})"
