"""What meets what, when, and how far apart it is at the start."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.building.simplices import distance
from carom.case.motion import Fixed
from carom.case.scenario import Scenario
from carom.case.signal import Signal
from carom.case.travel import travel, values
from carom.doctor.finding import Finding
from carom.doctor.flight import Flight, obstacle_gap
from carom.doctor.patient import Patient
from carom.doctor.touch import first_touch

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
    scenario = patient.scenario
    loaded = {load.body for load in scenario.loads}
    led = {body.name: _led(scenario, body.name) for body in scenario.bodies}
    unknown = loaded | {name for name, by_axis in led.items() if by_axis is None}
    foreseen = [pair for pair in pairs if not unknown.intersection(pair["between"])]
    foreseen = [pair for pair in foreseen if len(set(pair["between"])) == 2]
    flights = {
        body.name: flight
        for body, flight in zip(scenario.bodies, _flights(patient, led), strict=True)
    }
    gaps = [(_initial_gap(patient, pair, flights), pair) for pair in pairs]
    (gap, place), nearest = min(gaps, key=lambda found: found[0][0])
    if gap < 0 and _may_overlap(scenario, nearest["between"]):
        said = (
            f"{_names(nearest)} overlap at the start by {-gap:.4g} m at {_place(place)}, as their "
            "interference lets them"
        )
    else:
        said = (
            f"no overlap at the start; the nearest are {_names(nearest)}, {gap:.4g} m apart at "
            f"{_place(place)}"
        )
    yield Finding("ok", "bodies", said)
    # Of what static loads, or a start that is not drawn, make of the bodies nothing is foreseen.
    if len(patient.stages) > 1 or not patient.stages[0].is_dynamic or scenario.initial is not None:
        return
    yield from _first_touch(patient, foreseen, flights, others=len(pairs) - len(foreseen))


def _may_overlap(scenario: Scenario, between: Collection[str]) -> bool:
    """Return whether a pair takes up what overlaps at the start, or has an interference."""
    resolves = scenario.contact.resolve_overlap
    for pair in scenario.contact.pairs:
        if {*pair.between} == {*between}:
            own = pair.resolve_overlap
            return pair.interference is not None or (resolves if own is None else own)
    return resolves


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
    end = patient.scenario.end_time
    times, closest = [], []
    for pair in pairs:
        if (gap := _gap_over_time(patient, pair, flights)) is None:
            others += 1
            continue
        motion = _motion(patient, pair, flights)
        time, least = first_touch(gap, motion, end, tolerance=_tolerance(patient, pair))
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
    gravity = np.asarray(patient.stages[0].analysis.gravity or [0.0] * dimension, dtype=float)
    centres = patient.simulation.centres_of_mass()
    for body, boundary, centre in zip(scenario.bodies, patient.boundaries, centres, strict=True):
        spin: Any = (0.0 if dimension == 2 else [0.0] * 3) if body.spin is None else body.spin
        yield Flight(
            boundary,
            centre=centre,
            velocity=np.asarray(body.velocity or [0.0] * dimension, dtype=float),
            gravity=gravity,
            spin=np.asarray(spin, dtype=float),
            led=led[body.name] or {},
        )


def _gap_over_time(
    patient: Patient, pair: Mapping[str, Any], flights: Mapping[str, Flight]
) -> Callable[[float], float] | None:
    obstacles = {obstacle.name: k for k, obstacle in enumerate(patient.scenario.obstacles)}
    one, other = pair["between"]
    if one in obstacles:
        one, other = other, one
    flight = flights[one]
    if other not in obstacles:
        return lambda time: distance(flight.at(time), flights[other].at(time))[0]
    obstacle, dimension = patient.scenario.obstacles[obstacles[other]], patient.scenario.dimension

    def at(points: NDArray[np.float64]) -> NDArray[np.float64]:
        return patient.simulation.obstacle_gaps(obstacles[other], points)[0]

    if obstacle_gap(obstacle, flight.boundary, at) is None:
        return None

    def gap(time: float) -> float:
        moved = travel(obstacle, np.array([time]), dimension=dimension)[0]
        there = flight.at(time)
        return obstacle_gap(obstacle, there.at(there.points - moved), at) or 0.0

    return gap


def _motion(
    patient: Patient, pair: Mapping[str, Any], flights: Mapping[str, Flight]
) -> Callable[[float, float], float]:
    """Return how far points of a pair come nearer between two times at the most [m]."""
    obstacles = {obstacle.name: obstacle for obstacle in patient.scenario.obstacles}

    def path(name: str, start: float, end: float) -> NDArray[np.float64]:
        if name not in obstacles:
            return flights[name].at(end).points - flights[name].at(start).points
        times, dimension = np.array([start, end]), patient.scenario.dimension
        return np.diff(travel(obstacles[name], times, dimension=dimension), axis=0)

    def motion(start: float, end: float) -> float:
        one, other = (path(name, start, end) for name in pair["between"])
        common = one.mean(axis=0)
        return float(sum(np.linalg.norm(x - common, axis=1).max() for x in (one, other)))

    return motion


def _initial_gap(
    patient: Patient, pair: Mapping[str, Any], flights: Mapping[str, Flight]
) -> tuple[float, list[float]]:
    """Return the distance of a pair at the start [m] and where it is.

    What the core knows counts nodes of one side, and is right where it is the least.
    """
    there = float(pair["initial_gap"]), list(pair["at"])
    if len(set(pair["between"])) == 1:
        return there
    one, other = pair["between"]
    if one in flights and other in flights:
        gap, place = distance(flights[one].boundary, flights[other].boundary)
        return (gap, list(place)) if gap < there[0] else there
    gap_over_time = _gap_over_time(patient, pair, flights)
    gap = there[0] if gap_over_time is None else gap_over_time(0.0)
    return min(gap, there[0]), there[1]


def _tolerance(patient: Patient, pair: Mapping[str, Any]) -> float:
    """Return what distance counts as touching [m]: none but that of round-off."""
    edges = {b["name"]: float(b["smallest_edge"]) for b in patient.description["bodies"]}
    of_pair = [edges[name] for name in pair["between"] if name in edges]
    return 1e-9 * max(of_pair)


def _names(pair: Mapping[str, Any]) -> str:
    return " and ".join(pair["between"])


def _place(at: list[float]) -> str:
    return f"({', '.join(f'{x:.4g}' for x in at)})"
