"""How far the books close in long runs, under loads, and in scenes that nobody has chosen."""

from __future__ import annotations

import loads
import long_runs
import random_scenes

SCENES = 500

LONG_RUNS = """\
## 150,000 steps

`python benchmarks/long_runs.py`: the cylinders for {end:g} s at Δt = 1e-3 s, conserving; largest
defect over E₀ until a step, the exponent of its growth with the step number from {settled:,} on,
mean and standard deviation of the change per step.

{runs}

`massless` pays from vibration what a blend leaves over.
"""

LOADS = """\
## Loads and damping

`python benchmarks/loads.py`: cylinders under gravity at once (`tests/validation/test_loads.py`), μ
= 0.2, {end:g} s, eight contacts. What α cannot move where it is at its limit, vibration pays.

{cases}
"""

RANDOM_SCENES = """\
## Random scenes

`python benchmarks/random_scenes.py {count}`: 2 to 5 bodies thrown into a box, 800 steps each;
defects over the initial energy. The *largest* counts what parts of halved steps leave to one
another.

{scenes}

Not completed:

{failures}

{compared}
"""


def long_runs_section() -> str:
    """Run the cylinders for 150,000 steps."""
    return LONG_RUNS.format(
        end=long_runs.END, settled=long_runs.SETTLED, runs=long_runs.measured([])
    )


def loads_section() -> str:
    """Run the cylinders under gravity, with and without damping."""
    return LOADS.format(end=loads.END, cases=loads.measured())


def random_scenes_section() -> str:
    """Run random scenes with several schemes."""
    tallies = random_scenes.run(SCENES)
    failures = random_scenes.failures(tallies)
    return RANDOM_SCENES.format(
        count=SCENES,
        scenes=random_scenes.tabulated(tallies),
        failures="\n".join(f"- {failure}" for failure in failures) or "- none",
        compared=random_scenes.compared(tallies),
    )
