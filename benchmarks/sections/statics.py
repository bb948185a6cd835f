"""Static contact: against closed forms, an iron on a slab, scenes that nobody has chosen."""

from __future__ import annotations

import ironing
import press_fit
import static_references
import static_scenes

from .layout import IMAGES, power, table
from .pictures import draw_ironing

REFERENCES = """\
## Statics

`python benchmarks/static_references.py`: wedges and blocks on slopes, a bar on a rough bed,
punches, blocks and strips of rubber; asserted in `test_static_references.py`. Of a bar on a bed the
closed form is that of a thin one, 2F³/(3EAq) for ±F.

{references}

{seal}

`python benchmarks/press_fit.py`: a shaft in a hub against Lamé, by the interference of the pair, by
meshes that overlap, and by growth of the shaft, with cells of three sizes; asserted in
`test_press_fit.py`.

{pressures}

What pulls the shaft out, and how much that is off μ p A:

{pulls}
"""

IRONING = """\
## Shallow ironing

`python benchmarks/validate.py ironing`: an iron with a round sole and sharp corners, ten times as
stiff as the slab, goes 1 m down in 1 s and 10 m across in another, μ = 0.3, in steps of 0.01 s.
*Static* is without inertia; *stabilised* with `stabilisation = "dynamic"`, whose bridges take what
the column *lost* says, in terms of all work. Means and scatter, their standard deviation over the
mean, are of 1.2 s to 1.8 s, in MN/m.

{runs}

{endings}

That the state in which node to segment stops is unstable is not proven:
record 29 of `docs/decisions` has what is known.

![Forces on the iron](images/ironing.png)
"""


SCENES = 200

SCATTERED = """\
## Random static scenes

`python benchmarks/static_scenes.py {count}`: blocks pressed on blocks, sheared, bent over posts and
balls, squeezed between plates; all laws and cells, μ from 0 to 1, meshes that do not fit, in the
plane and in space, ten load steps each. A scene that does not complete is listed with its reason.

{summary}

{failures}
"""


def references_section() -> str:
    """Run everything that has a closed form."""
    return REFERENCES.format(
        references=static_references.tabulated(),
        seal=static_references.sealed(),
        pressures=press_fit.pressures(),
        pulls=press_fit.pulls(),
    )


def ironing_section() -> str:
    """Draw the iron across the slab in every way."""
    runs = ironing.all_runs()
    draw_ironing(runs, IMAGES / "ironing.png")
    return IRONING.format(runs=_ironing_table(runs), endings=_endings(runs))


def _ironing_table(runs: dict[tuple[str, str], ironing.Ironing]) -> str:
    rows = []
    for (discretisation, way), run in runs.items():
        energy = run.summary["energy"]
        forces = ("–",) * 4
        if run.slides_to_the_end:
            (along, across), (ripple, other) = run.means(), run.scatter()
            drawn, pressed = (f"{1e-6 * force:.1f}" for force in (along, across))
            forces = (drawn, f"{100 * ripple:.1f} %", pressed, f"{100 * other:.2f} %")
        rows.append(
            (
                discretisation,
                way,
                run.summary["status"],
                f"{run.history['time'][-1]:.3f}",
                *forces,
                f"{100 * energy['scheme'] / energy['prescribed']:.1f} %",
                power(energy["max_defect"] / energy["prescribed"]),
                run.summary["newton_iterations"],
                run.summary["retried_steps"],
            )
        )
    head = ("discretisation", "analysis", "status", "until [s]", "draws", "scatter", "presses")
    return table((*head, "scatter", "lost", "defect", "iterations", "tried again"), rows)


def _endings(runs: dict[tuple[str, str], ironing.Ironing]) -> str:
    failed = [
        f"- {discretisation}, {way}: {run.status}"
        for (discretisation, way), run in runs.items()
        if run.status != "completed"
    ]
    return "\n".join(failed) or "All complete."


def scenes_section() -> str:
    """Run random static scenes."""
    tally = static_scenes.run(SCENES)
    failures = "\n".join(f"- {each}" for each in tally.failures) or "All complete."
    return SCATTERED.format(count=SCENES, summary=tally.in_words(), failures=failures)
