"""Going through time step by step, in a loop of one's own."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.building.build import build
from carom.case.scenario import Scenario
from carom.errors import ConvergenceError, InputError
from carom.ledger_terms import Ledger
from carom.messages import known
from carom.running.energy import Energy
from carom.running.state import State


@dataclass(frozen=True)
class Step:
    """What a step says about itself.

    Parameters
    ----------
    index
        Its number, from 1.
    time
        Time at its end [s].
    substeps
        Steps that it was taken in: 1, or more where it had to be halved.
    iterations
        Newton iterations of all of these.
    contacts
        Contacts that press at its end.
    normal_force
        Sum of their normal reactions [N].
    min_gap
        Smallest gap at its end [m]; infinite where nothing is near.
    certificate
        How far its contacts are from Coulomb's law [J].
    energy
        Kinetic and strain energy at its end.
    ledger
        What happened to the energy in it.
    """

    index: int
    time: float
    substeps: int
    iterations: int
    contacts: int
    normal_force: float
    min_gap: float
    certificate: float
    energy: Energy
    ledger: Ledger


class Simulation(State):
    """A scenario built into meshes, matrices and a state, to be taken through time by hand.

    `carom.run` is what makes results; this writes no files. It makes the very same steps.

    Parameters
    ----------
    scenario
        What to simulate.

    Raises
    ------
    InputError
        The scenario cannot be run, such as bodies that overlap at the start.
    """

    def __init__(self, scenario: Scenario) -> None:
        super().__init__(scenario, build(scenario))
        self._rows: list[NDArray[np.float64]] = []
        self._failure: ConvergenceError | None = None

    @property
    def has_ended(self) -> bool:
        """Whether the end of the case is reached."""
        return self._native.step >= self._native.steps

    @property
    def resting(self) -> list[str]:
        """Names of the bodies at rest, which take no part in steps until something changes."""
        rests = zip(self.bodies, self._native.resting(), strict=True)
        return [name for name, is_at_rest in rests if is_at_rest]

    def step(self) -> Step:
        """Go on by one time step.

        Raises
        ------
        ConvergenceError
            The step failed, however short; the state is that after the last good part of it, and
            the simulation goes no further.
        InputError
            There is no step left.
        """
        if self.has_ended:
            raise InputError(
                f"the simulation has ended at t = {self.time:g} s; give a later analysis.end_time"
            )
        self._advance(math.inf, budget=0.0)
        report = self._native.nominal_step()
        gap = report["min_gap"]
        return Step(
            index=self._native.step,
            time=self.time,
            substeps=report["substeps"],
            iterations=report["newton_iterations"],
            contacts=report["contacts"],
            normal_force=report["normal_force"],
            min_gap=math.inf if gap is None else gap,
            certificate=report["certificate"],
            energy=self.energy,
            ledger=Ledger(**report["ledger"]),
        )

    def advance(self, until: float) -> None:
        """Go on to the first end of a step at a time [s] or after it; to the end at most.

        Raises
        ------
        ConvergenceError
            A step failed; see `step`.
        InputError
            The time is not a number.
        """
        if math.isnan(until):
            raise InputError("until: must be a time, not nan")
        self._advance(until, budget=math.inf)

    def _advance(self, until: float, *, budget: float) -> None:
        if self._failure is not None:
            raise self._failure
        try:
            self._native.advance(until, budget)
        except ConvergenceError as failure:
            self._failure = failure
            raise

    def set_velocity(self, body: str, velocity: ArrayLike) -> None:
        """Give the nodes of a body their initial velocities.

        Only before the first step: later it would be energy out of nowhere, which no term of the
        ledger has. Forces that change over time are loads, see `Force` and `Pressure`. Nodes that
        are held move as prescribed.

        Parameters
        ----------
        body
            Its name.
        velocity
            Velocities [m/s], shape [n, D] as those of `BodyState.points`, or [D] for all nodes.

        Raises
        ------
        InputError
            There is no such body, the shape is another, a value is not finite, a step was made, or
            the analysis knows no velocities.
        """
        if body not in self.bodies:
            raise InputError(f"{body}: no such body; {known(body, list(self.bodies))}")
        if not self.scenario.full_stages()[0].is_dynamic:
            raise InputError("a static analysis has no velocities")
        if self.scenario.initial is not None and self.scenario.initial.result is not None:
            raise InputError(
                f"{body}: the case goes on from a result, with the velocities of that; give others "
                "in the velocities of a stage"
            )
        if self.steps > 0:
            raise InputError(
                f"{body}: velocities are set before the first step; afterwards the energy would "
                "come from nowhere: apply a load instead"
            )
        now = self.bodies[body].velocity
        given = np.asarray(velocity, dtype=np.float64)
        if given.shape not in (now.shape, now.shape[1:]):
            raise InputError(
                f"{body}: velocities must have the shape {now.shape} or {now.shape[1:]}, "
                f"not {given.shape}"
            )
        if not np.isfinite(given).all():
            raise InputError(f"{body}: velocities must be finite")
        everything = self._moment.state["velocity"].copy()
        everything[self.bodies[body].nodes] = given
        self._native.set_initial_velocity(everything)
        self._rows.clear()
        self._moment.forget()

    @property
    def history(self) -> dict[str, NDArray[np.float64]]:
        """What ``history.csv`` of a run would have so far: columns by title, shape [row_count].

        A row every ``output.history_every``, and one at the end.
        """
        if self.has_ended:
            self._native.finish()
        self._rows.append(self._native.take_history())
        rows = np.concatenate(self._rows)
        self._rows = [rows]
        return dict(zip(self._native.history_columns(), rows.T.copy(), strict=True))
