"""Whether what a run gives is what a page says."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .manifest import Claim
from .pages import Number

ALLOWED = {
    "exact": "one unit of the last digit shown",
    "count": "equal",
    "round-off": "between a thirtieth and thirty times the number",
    "bound": "at most the number, and at least a thirtieth of it",
    "timing": "told, never judged",
}
"""What a kind of claim allows where the claim itself does not say it.

Sums of rounding errors change with the order in which a compiler adds, thus the wide band; a bound
far above what is measured says nothing, thus the lower end."""

ROUND_OFF = 30.0


@dataclass(frozen=True)
class Verdict:
    """What became of a number.

    Parameters
    ----------
    claim, number
        What the page says.
    measured
        What the run gave.
    holds
        Whether they agree; always, for a timing.
    """

    claim: Claim
    number: Number
    measured: float
    holds: bool

    def __str__(self) -> str:
        """One line: page, number on it, what was measured, what is allowed."""
        ratio = ""
        if self.claim.kind == "timing" and self.number.value != 0.0:
            ratio = f", {self.measured / self.number.value:.2f} times that"
        return (
            f"{self.claim.page}: «{self.number.shown}» in “{self.claim.plain}”: "
            f"{self.claim.run} gives {self.measured:.6g}{ratio} (allowed: {allowed(self.claim)})"
        )


def judged(claim: Claim, values: list[float]) -> list[Verdict]:
    """Compare what a run gave with the numbers of a claim.

    Raises
    ------
    ValueError
        If there are not as many values as numbers.
    """
    if len(values) != len(claim.numbers):
        raise ValueError(
            f"{claim.page}: “{claim.plain}” has {len(claim.numbers)} numbers, "
            f"{claim.run} gives {len(values)}"
        )
    return [
        Verdict(claim, number, value, _holds(claim, number, value))
        for number, value in zip(
            claim.numbers, (claim.scale * each for each in values), strict=True
        )
    ]


def allowed(claim: Claim) -> str:
    """Say what a number may be off by."""
    if claim.kind == "timing":
        return ALLOWED["timing"]
    if claim.absolute is not None:
        return f"± {claim.absolute:g}"
    if claim.relative is not None:
        return f"± {100 * claim.relative:g} %"
    if claim.factor is not None:
        return f"a factor of {claim.factor:g}"
    return ALLOWED[claim.kind]


def _holds(claim: Claim, number: Number, value: float) -> bool:
    said, size = number.value, abs(number.value)
    factor = claim.factor or ROUND_OFF
    if claim.kind == "timing" or not math.isfinite(value):
        return claim.kind == "timing"
    if claim.absolute is not None:
        return abs(value - said) <= claim.absolute
    if claim.relative is not None:
        # Relative to what the page says; of a zero nothing but zero is a part.
        return abs(value - said) <= claim.relative * size
    if claim.kind == "bound":
        return size / factor <= abs(value) <= size
    if claim.kind == "round-off" or claim.factor is not None:
        # The sign of a rounding error means nothing.
        return size / factor <= abs(value) <= factor * size
    # A little more than a unit, for the round-off of this very difference.
    return abs(value - said) <= (0.0 if claim.kind == "count" else 1.001 * number.last_digit)
