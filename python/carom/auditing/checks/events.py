"""Checks of the contact events of the summary against history, ledger and stored steps."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.checks.pressing import PRESSED, Pressing, PressingOfRun
from carom.auditing.records.numbers import number
from carom.auditing.records.parts import Part
from carom.auditing.records.rows import GRID, Rows
from carom.auditing.report import Findings
from carom.auditing.steps.scales import EPS, ROUND_OFF, SAFETY, Scales
from carom.ledger_terms import names

TERMS = names("pair")
"""What a pair does to the energy; any of it shows that it pressed."""

TURNED = 2e-3
"""How much less of an impulse is along the normal of the step than along that of its end, where
bodies do not turn.

Where they turn, the angle that both turn by in a step comes to that: as much of its friction is
along the normal of the step.
"""

PINNED = 5e-3
"""A figure is known if its bounds are no farther apart than this part of it."""

FLICKER = 3.0
"""Steps for which a pair that stays in contact may be without a force."""

STORE = "output.history_every = the time step"


@dataclass(frozen=True)
class Event:
    """A contact event.

    Parameters
    ----------
    index
        Its place in the summary.
    pair
        The pair, as the ledger calls it.
    onset, release
        First and last time with a reaction [s]; infinite while it may go on.
    has_impact
        Whether it says what the impact did.
    peak
        Largest normal force [N].
    friction
        Dissipated by friction [J].
    """

    index: int
    pair: str
    onset: float
    release: float
    has_impact: bool
    peak: float
    friction: float


class EventChecks:
    """Checks of events.

    Parameters
    ----------
    parts
        The stages of the run, each with its magnitudes.
    findings
        Where what is found goes.
    rows
        The history.
    ledger
        The columns of every body and pair.
    summary
        What ``summary.json`` says.
    stored
        For the times of stored steps [s] the normal forces of the pairs that press [N].
    """

    def __init__(
        self,
        parts: Sequence[tuple[Part, Scales]],
        findings: Findings,
        rows: Rows,
        *,
        ledger: Mapping[str, Mapping[str, Array]],
        summary: Mapping[str, Any],
        stored: Mapping[float, Mapping[frozenset[str], float]],
    ) -> None:
        self._models = [part.model for part, _ in parts]
        model, self._scales = self._models[-1], parts[-1][1]
        self._model = model
        self._massless = any(model.massless for model in self._models)
        self._jolts = any(model.jolts for model in self._models)
        self._coheres = any(model.coheres for model in self._models)
        """Whether pairs may pull: they have books, but no event while they do not press."""
        self._check, self._leave = findings.check, findings.leave
        self._rows = rows
        named = {f"{a}|{b}": frozenset((a, b)) for a, b in model.pairs()}
        self._pairs = {name: between for name, between in named.items() if name in ledger}
        self._first = {
            name: int(np.searchsorted(rows.times, ledger[name]["time"][0])) for name in self._pairs
        }
        self._friction = {name: self._padded(ledger[name]["friction"]) for name in self._pairs}
        self._did = {
            name: np.max(
                [np.abs(np.diff(self._padded(ledger[name][term]), prepend=0.0)) for term in TERMS],
                axis=0,
            )
            for name in self._pairs
        }
        self._rubs = {name: did != 0 for name, did in self._did.items()}
        """Whether the pair did something between the row before and this one, by pair."""
        stages = [
            (part.first, Pressing(part.model, scales, part.rows, self._pairs, stored))
            for part, scales in parts
        ]
        self._pressing = PressingOfRun(stages, rows.history["normal_force"])
        names = {between: name for name, between in self._pairs.items()}
        self._events = [
            Event(
                index=index,
                pair=names.get(frozenset(event["pair"]), ""),
                onset=float(event["onset"]),
                release=np.inf if event["release"] is None else float(event["release"]),
                peak=number(event["peak_force"]),
                friction=number(event["friction_work"]),
                has_impact=event.get("impact") is not None,
            )
            for index, event in enumerate(summary["contacts"])
        ]
        self.known = np.zeros(len(rows), dtype=bool)
        """Rows whose normal force is known from something else, [row_count]."""
        self._merge = {
            name: number(said.get("merge_contacts", model.scenario.output.merge_contacts))
            for name, between in named.items()
            for said in summary["pairs"]
            if set(said["between"]) == between
        }
        """Pauses of pairs shorter than this belong to an event [s]."""
        self._claims = [self._claimed(row) for row in range(len(rows))]

    def all(self) -> None:
        """Check everything."""
        strangers = [float(not event.pair) for event in self._events]
        self._check("events: pairs", strangers, 0.0, "events of pairs that have not touched")
        silent = () if self._coheres else self._pairs
        without = [float(not self._of(pair)) for pair in silent]
        self._check("events: pairs", without, 0.0, "pairs that have touched without an event")
        if any(strangers) or any(without):
            return
        onsets = np.array([event.onset for event in self._events])
        self._check("events: times", np.maximum(-np.diff(onsets), 0.0), 0.0, "order of events")
        self._merges()
        self._forces()
        for pair in self._pairs:
            events = self._of(pair)
            for event in events:
                self._times(event, first=event is events[0], last=event is events[-1])
                self._peak(event)
            self._pauses(pair, events)
            if events:
                self._work(pair, events)

    def _padded(self, values: Array) -> Array:
        """Return a column of a pair at all rows, 0 before it touched."""
        return np.concatenate([np.zeros(len(self._rows) - len(values)), values])

    def _of(self, pair: str) -> list[Event]:
        return [event for event in self._events if event.pair == pair]

    def _claimed(self, row: int) -> list[str]:
        """Return the pairs in whose events a row is."""
        time = self._rows.times[row]
        return [e.pair for e in self._events if e.onset <= time <= e.release and e.pair]

    def _forces(self) -> None:
        """Check that the forces of rows are those of the pairs in whose events they are."""
        rows, total = self._rows, self._pressing.total
        alone = np.array([float(not claims) for claims in self._claims])
        turned = 2.0 * rows.dt * rows.turning()
        turned = self._jolts * (
            TURNED + np.maximum(turned, np.concatenate([turned[:1], turned[:-1]]))
        )
        # What pulls has none.
        pressed = np.maximum(total, 0.0) if self._coheres else total
        self._check("events: force", pressed * alone, 0.0, "force without an event")
        for row in np.flatnonzero(total > 0):
            where = f"t = {rows.times[row]:g} s"
            bounds = self._pressing.apart(int(row), self._claims[row])
            peaks = {e.pair: e.peak for e in self._events if self._holds(e, int(row))}
            low = sum(bound[0] for bound in bounds.values())
            high = sum(min(bound[1], peaks[name]) for name, bound in bounds.items())
            off = (PRESSED + turned[row]) * total[row]
            if not self._coheres:
                self._check("events: force", max(low - total[row], 0.0), off, where)
            self._check("events: force", max(total[row] - high, 0.0), off, where)
            self.known[row] = high - low <= PINNED * total[row]

    def _holds(self, event: Event, row: int) -> bool:
        return event.onset <= float(self._rows.times[row]) <= event.release

    # The times of an event.

    def _presses(self, pair: str, row: int) -> bool:
        """Return whether the pair must have pressed at a row."""
        if self._pressing.total[row] <= 0:
            return False
        others = set(self._claims[row]) - {pair}
        if not others:
            return True
        rubs = self._rows.single[row] and self._rubs[pair][row]
        if rubs and not (self._massless or self._coheres):
            return True
        return self._pressing.bounds(row, [*others, pair])[pair][0] > 0

    def _cannot(self, pair: str, row: int) -> bool:
        """Return whether the pair cannot have pressed at a row, or with less than can be told."""
        total = float(self._pressing.total[row])
        if self._coheres:
            bounds = self._pressing.bounds(row, [*self._claims[row], pair])
            return bounds[pair][1] <= PINNED * max(total, 0.0)
        if total <= 0:
            return True
        if self._rubs[pair][row]:
            return False
        names = {*self._claims[row], pair}
        return self._pressing.bounds(row, names)[pair][1] <= PINNED * total

    def _times(self, event: Event, *, first: bool, last: bool) -> None:
        rows, check = self._rows, self._check
        at = f"{event.pair}, event {event.index}"
        check("events: times", max(event.onset - event.release, 0.0), 0.0, f"{at}, order")
        # Load steps have no duration, and what presses in them gives no impulse.
        ended, at_rest = np.isfinite(event.release), all(m.static for m in self._models)
        some = any(m.static for m in self._models)
        differ = event.has_impact > (ended and not at_rest)
        differ = differ or (ended and not some and not event.has_impact)
        check("events: times", float(differ), 0.0, f"{at}, impacts are of contacts that have ended")
        if first and not self._coheres:
            touch = self._first[event.pair]
            before = rows.times[touch - 1] if touch else -np.inf
            off = max(event.onset - rows.times[touch], before - event.onset, 0.0)
            check("events: times", off, 0.0, f"{at}, first touch")
            check("events: times", float(event.onset == before), 0.0, f"{at}, first touch")
        for name, time in (("onset", event.onset), ("release", event.release)):
            if np.isfinite(time):
                check("events: times", self._off_grid(time), 0.0, f"{at}, {name} on the grid")
                row = rows.at(time)
                idle = row is not None and rows.single[row] and self._cannot(event.pair, row)
                check("events: times", float(idle), 0.0, f"{at}, no force at its {name}")
        if np.isinf(event.release):
            idle = not last or self._cannot(event.pair, len(rows) - 1)
            check("events: times", float(idle), 0.0, f"{at}, no force at the end of the run")
        else:
            # An event that has a reaction in the last step goes on.
            left = float(event.release >= rows.times[-1])
            check("events: times", left, 0.0, f"{at}, release at the end of the run")
        if not self._onset_is_known(event, first=first):
            self._leave(
                "when an event began, where not every step has a row or others press too",
                f"summary.json: contacts.{event.index}.onset",
                store=STORE,
            )
        if event.has_impact:
            self._leave(
                "what an impact did: how bodies moved in themselves at its start and its end",
                f"summary.json: contacts.{event.index}.impact",
                store="",
            )
        if not self._release_is_known(event):
            self._leave(
                "when an event ended, where not every step has a row or others press too",
                f"summary.json: contacts.{event.index}.release",
                store=STORE,
            )

    def _off_grid(self, time: float) -> float:
        """Return how far a time is from the ends of steps, or of their halves, quarters … [s]."""
        model = next((m for m in self._models if time <= m.stage.end_time), self._model)
        analysis, since = model.analysis, time - model.stage.start_time
        finest = analysis.time_step * 0.5**analysis.max_halvings
        nominal = model.stage.start_time + np.rint(since / analysis.time_step) * analysis.time_step
        off = abs(since - np.rint(since / finest) * finest)
        if not (self._rows.history["retried_steps"] > 0).any():
            off = abs(time - nominal)
        off = min(off, abs(time - analysis.end_time))
        return 0.0 if off <= GRID * finest else float(off)

    def _onset_is_known(self, event: Event, *, first: bool) -> bool:
        row = self._rows.at(event.onset)
        if row is None or not self._rows.single[row]:
            return False
        if first and row == self._first[event.pair] and not self._coheres:
            return True
        return self._presses(event.pair, row) and self._cannot(event.pair, row - 1)

    def _release_is_known(self, event: Event) -> bool:
        end = len(self._rows) - 1
        if np.isinf(event.release):
            return self._presses(event.pair, end)
        row = self._rows.at(event.release)
        if row is None or row == end or not self._rows.single[row : row + 2].all():
            return False
        return self._presses(event.pair, row) and self._cannot(event.pair, row + 1)

    def _merges(self) -> None:
        """Check how close contacts are that count as one: as the case says, or waves run.

        While a pressure wave runs along the longest side of a body, contacts may open and close.
        """
        given = self._model.scenario.output.merge_contacts
        waves = {
            body.name: float(np.ptp(body.points, axis=0).max()) / body.law.wave_speed
            for body in self._model.bodies
            if body.carries_waves
        }
        for pair, merge in self._merge.items():
            own = min((waves[name] for name in pair.split("|") if name in waves), default=0.0)
            wanted = max(own, FLICKER * self._rows.dt) if given is None else given
            if given is None and self._model.static:
                wanted = 0.0  # times of load steps do not say how long anything lasts
            off = ROUND_OFF * wanted if given is None else 0.0
            self._check("events: times", merge - wanted, off, f"{pair}, merge_contacts")

    # Its force.

    def _peak(self, event: Event) -> None:
        rows = self._rows
        inside = [row for row in range(1, len(rows)) if self._holds(event, row)]
        bounds = [self._pressing.bounds(row, self._claims[row])[event.pair] for row in inside]
        low = max((bound[0] for bound in bounds), default=0.0)
        at = f"{event.pair}, event {event.index}"
        ends = (event.onset, min(event.release, float(rows.times[-1])))
        whole = all(rows.at(time) is not None for time in ends) and rows.single[inside].all()
        self._check("events: peak force", max(low - event.peak, 0.0), PRESSED * low, at)
        self._check("events: peak force", float(not event.peak > 0), 0.0, at)
        high = max((bound[1] for bound in bounds), default=0.0) if whole else np.inf
        if whole:
            self._check("events: peak force", max(event.peak - high, 0.0), PRESSED * high, at)
        if high - low > PINNED * low:
            self._leave(
                "peak forces of events, where not every step has a row or others press too",
                f"summary.json: contacts.{event.index}.peak_force",
                store=STORE,
            )

    def _pauses(self, pair: str, events: list[Event]) -> None:
        """Check that pauses within an event are shorter than those between two."""
        rows, merge = self._rows, self._merge.get(pair, np.nan)
        slack = GRID * min(model.analysis.time_step for model in self._models)
        for before, after in pairwise(events):
            row = rows.at(after.onset)
            known = row is not None and rows.single[row]
            start = rows.times[row - 1] if row is not None and known else after.onset
            pause = start - before.release
            at = f"{pair}, events {before.index} and {after.index}"
            self._check("events: times", max(merge - pause, 0.0), slack, f"{at}, pause")
        for event in events:
            inside = [row for row in range(1, len(rows)) if self._holds(event, row)]
            if not inside or not rows.single[inside].all():
                continue
            pressed = [row for row in inside if not self._cannot(pair, row)]
            pauses = [rows.times[b - 1] - rows.times[a] for a, b in pairwise(pressed)]
            longest = max((p for p in pauses if p > slack), default=0.0)
            at = f"{pair}, event {event.index}"
            self._check("events: times", max(longest - merge, 0.0), slack, f"{at}, pause")
        if not (self._massless or self._coheres):
            # What a pair did between two rows, it did in an event; but impulses that let contacts
            # settle may be left of one, too small for a digit of the energy.
            for row in np.flatnonzero(self._did[pair] > EPS * self._scales.energy)[1:]:
                # A load step has a part of what pressed at its start.
                since = rows.times[max(row - 2, 0) if self._model.static else row - 1]
                covered = any(e.onset <= rows.times[row] and e.release > since for e in events)
                where = f"{pair}, t = {rows.times[row]:g} s"
                self._check("events: times", float(not covered), 0.0, f"{where}, without an event")

    # Its work.

    def _work(self, pair: str, events: list[Event]) -> None:
        """Check the friction of events by what the pair had dissipated when each began."""
        friction = self._friction[pair]
        size = float(np.abs(friction).max())
        off = SAFETY * ROUND_OFF * max(size, self._scales.energy * ROUND_OFF)
        starts = [self._before(pair, event) for event in events]
        if not self._coheres:
            starts[0] = (0.0, 0.0)
        ends = [*starts[1:], (float(friction[-1]), float(friction[-1]))]
        for event, start, end in zip(events, starts, ends, strict=True):
            low, high = end[0] - start[1], end[1] - start[0]
            at = f"{pair}, event {event.index}"
            self._check("events: friction", max(low - event.friction, 0.0), off, at)
            self._check("events: friction", max(event.friction - high, 0.0), off, at)
            if not high - low <= PINNED * abs(event.friction):
                self._leave(
                    "friction of events that begin between two rows",
                    f"summary.json: contacts.{event.index}.friction_work",
                    store=STORE,
                )

    def _before(self, pair: str, event: Event) -> tuple[float, float]:
        """Return what the pair had dissipated when the first step of an event began [J]."""
        rows, friction = self._rows, self._friction[pair]
        row = int(np.searchsorted(rows.times, event.onset))
        if not 0 < row < len(rows):
            return (-np.inf, np.inf)
        before, after = float(friction[row - 1]), float(friction[row])
        if rows.single[row]:
            return before, before
        # What holds slides by round-off, whose work is of either sign.
        return (-np.inf, np.inf) if self._coheres else (min(before, after), max(before, after))
