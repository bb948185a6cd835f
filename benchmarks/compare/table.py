"""The runs of a problem as a table, and what is odd about them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import dist, hypot, isnan
from statistics import median

from compare.catalogue import CODES
from compare.outcome import Job, Outcome
from compare.problems import Problem

HEADINGS = (
    "code", "μ", "dofs", "Δt [s]", "steps", "ms per step", "÷ carom `theta`",
    "÷ carom `conserving`", "ΔE/E₀ at the end", "largest |ΔE|/E₀", "bodies first touched [s]",
    "second body at the end [m/s]",
)  # fmt: skip

LATE = 5
"""How many looks the times of first contact of two codes may differ by: penalties are soft."""
FAST = 0.05
"""How much the last velocity may differ, relative to the largest at the start."""
LOST = 0.02
"""How much of its energy a motion may gain or lose without friction."""

Runs = Mapping[Job, Sequence[Outcome]]


def table(problem: Problem, runs: Runs) -> str:
    """Return the medians as a Markdown table, with ratios to carom at the same friction."""
    rows = [_row(problem, job, outcomes, runs) for job, outcomes in runs.items() if outcomes]
    for name, milliseconds in problem.earlier:
        label = f"{name}: measured earlier, not in this run"
        rows.append([label, "0", *[""] * 3, f"{milliseconds:g}", *[""] * 6])
    lines = [HEADINGS, ["---"] * len(HEADINGS), *rows]
    return "\n".join(f"| {' | '.join(_cell(entry) for entry in line)} |" for line in lines)


def _cell(entry: str) -> str:
    return entry.replace("|", "&#124;")


def _row(problem: Problem, job: Job, outcomes: Sequence[Outcome], runs: Runs) -> list[str]:
    """Return a run in the order of the headings."""
    code, last = CODES[job.code], outcomes[-1]
    motion = last.motion
    spent = _spent(outcomes)
    ratios = [
        f"{spent / _spent(others):.3g}" if (others := _carom(job, scheme, runs)) else ""
        for scheme in ("theta/gap", "conserving/midpoint")
    ]
    return [
        f"{code.title} {last.version}, {code.variants[job.variant]}",
        f"{job.friction:g}",
        f"{last.dofs:,}",
        f"{problem.time_step:g}",
        f"{last.steps}",
        f"{spent:.3g}",
        *ratios,
        f"{motion.change:+.1e}",
        f"{motion.excursion:.1e}",
        ", ".join(dict.fromkeys(_time(time, problem) for time in motion.touches)),
        "({}, {})".format(*map(_speed, motion.last_velocity)),
    ]


def _spent(outcomes: Sequence[Outcome]) -> float:
    """Return the median time of a step [ms]."""
    return median(outcome.milliseconds for outcome in outcomes)


def _carom(job: Job, scheme: str, runs: Runs) -> Sequence[Outcome]:
    """Return the runs of carom, in this scheme, at the friction of a job."""
    return next(
        (
            outcomes
            for other, outcomes in runs.items()
            if (other.code, other.variant, other.friction) == ("carom", scheme, job.friction)
        ),
        (),
    )


def _time(value: float, problem: Problem) -> str:
    """Return a time to the time step."""
    decimals = len(f"{problem.time_step:.10f}".rstrip("0").partition(".")[2])
    return "never" if isnan(value) else f"{value:.{decimals}f}"


def _speed(value: float) -> str:
    """Return a speed, without the sign of a zero."""
    return f"{round(value, 3) + 0.0:.3f}"


def differences(problem: Problem, runs: Runs) -> Iterator[str]:
    """Yield where a run did not converge, or not to carom's motion in the first scheme."""
    allowed = LATE * problem.sample_every * problem.time_step * (1 + 1e-9)
    for job, outcomes in runs.items():
        if not (outcomes and (reference := _carom(job, "theta/gap", runs))):
            continue
        motion, expected = outcomes[-1].motion, reference[-1].motion
        if exhausted := outcomes[-1].exhausted:
            yield f"{job}: {exhausted} of {outcomes[-1].steps} steps took all iterations allowed"
        for time, known in zip(motion.touches, expected.touches, strict=True):
            both_never = isnan(time) and isnan(known)
            if not (both_never or abs(time - known) <= allowed):
                yield f"{job}: a body is first touched at {time:g} s, in carom at {known:g} s"
        if dist(motion.last_velocity, expected.last_velocity) > FAST * _fastest(problem):
            yield f"{job}: the second body does not end with the velocity that it has in carom"
        if not job.friction and abs(motion.change) > LOST:
            yield f"{job}: the energy changes by {motion.change:+.1%}"


def _fastest(problem: Problem) -> float:
    """Return the largest speed of a body at the start [m/s]."""
    return max(hypot(*body.velocity) for body in problem.bodies)
