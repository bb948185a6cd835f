"""Checks of the blend of stresses of a stored step, and of what it leaves over."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Indices
from carom.auditing.report import Findings
from carom.auditing.steps.scales import ROUND_OFF, Scales
from carom.auditing.steps.step import Step, defect

LARGEST_BLEND = 2.0
"""Limit of |α|."""

KEPT = 0.5
"""The largest |α| of iterations that find none that closes the balance."""

LARGEST_PART = 0.5
"""The largest part of the energy of vibration that a step may take or give."""

UNCLEAR = 1e-8
"""What a blend can move below this share of the energy is not sure to be clear of round-off."""

NEGLIGIBLE = 1e-14
"""What is missing below this part of the energy may wait."""


class BlendChecks:
    """Checks of blends.

    Parameters
    ----------
    scales
        The magnitudes of the model.
    findings
        Where what is found goes.
    """

    def __init__(self, scales: Scales, findings: Findings) -> None:
        self._scales, self._findings = scales, findings
        self._check = findings.check

    def step(self, step: Step, work: float, sums: float, where: str) -> None:
        """Check that α is what the balance of its group asks for, and what is left for later.

        Parameters
        ----------
        step
            The step.
        work
            How far its energies may be off balance [J].
        sums
            How far sums of energies may be off [J].
        where
            Where this is.
        """
        missing, available = step.groups.balance()
        alpha, (least, largest) = step.blend, step.groups.blend_range(LARGEST_BLEND)
        leaders, books = np.unique(step.groups.blends), np.unique(step.groups.books)
        beyond = np.maximum(np.maximum(alpha - largest, least - alpha), 0.0)
        self._check("blend", beyond[leaders], ROUND_OFF * LARGEST_BLEND, where)
        self._check("blend", alpha - alpha[step.groups.blends], 0.0, where)
        limits = np.sort([least * available, largest * available], axis=0)
        # Where there is next to nothing to move α stays within the step.
        within = 0.5 * np.maximum(available, 0.0) * [[-1.0], [1.0]]
        unclear = np.abs(available) < UNCLEAR * self._scales.energy
        moved = alpha * available
        error = moved - np.clip(missing, *limits)
        other = moved - np.clip(missing, *within)
        error = np.where(unclear & (np.abs(other) < np.abs(error)), other, error)
        limits = np.where(unclear, within, limits)
        allowed = work + NEGLIGIBLE * self._scales.energy
        # Iterations that find no α go on with one; what it leaves over is paid or waits.
        kept = (np.abs(error) > allowed) & (np.abs(alpha) <= KEPT)
        error = np.where(kept, 0.0, error)
        self._check("blend", error[leaders], allowed, where)
        self._repaid(step, books, allowed, where)
        stored, left = step.end["energy_debt"], step.left_over
        followers = np.setdiff1d(np.arange(len(alpha)), books)
        self._check("waiting energy", stored[followers], 0.0, where)
        self._check("waiting energy", (stored - left)[books], sums, where)
        # Its own books have no more than round-off.
        error = (stored - step.start["energy_debt"]).sum() - defect(step.ledger)
        sums = ROUND_OFF * (self._scales.energy + sum(abs(e) for e in step.ledger.values()))
        self._check("waiting energy", error, sums, where)
        full = np.zeros(len(alpha), dtype=bool)
        beyond_limits = (missing < limits[0] + work) | (missing > limits[1] - work) | kept
        np.logical_or.at(full, step.groups.books[leaders], beyond_limits[leaders])
        if full.any():
            self._findings.leave(
                "energy that waits: a blend of stresses is at its limit, or has little to move"
            )
        self._check("energy of the step", stored[books][~full[books]], allowed, where)

    def _repaid(self, step: Step, leaders: Indices, allowed: float, where: str) -> None:
        """Check that vibration pays what the blend leaves over, as far as it may.

        Parameters
        ----------
        step
            The step.
        leaders
            The bodies that stand for their groups.
        allowed
            How far what is left over may be off [J].
        where
            Where this is.
        """
        shares = step.shares
        self._check("repaying", shares - shares[step.groups.books], ROUND_OFF, where)
        if not shares.any():
            return
        vibration, repaid = (
            np.bincount(step.groups.books, weights=energy, minlength=len(shares))[leaders]
            for energy in (step.vibration, step.repaid)
        )
        debt = step.left_over[leaders] - repaid
        most = LARGEST_PART * vibration
        error = np.where(shares[leaders] == 0.0, 0.0, repaid + np.clip(debt, -most, most))
        self._check("repaying", error, allowed, where)
