"""Round bodies in space as smooth targets and as facets: what is kept, how quiet, and at what cost.

Balls that collide in free space, and in the box of ``examples/two_balls.toml``; a ball that slides
over a coarse shaft, and one that slides and rolls down a coarse sphere; a shaft in a hub with other
facets, against Lamé. How round the surfaces are, and that their normals do not jump, is measured by
``cargo test --release -p carom-contact --lib sheet -- --nocapture``.

.venv/bin/python benchmarks/smooth_targets.py [collisions] [box] [slide] [roll] [fits]
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import round_targets
from runs import example, simulate
from sections.layout import table


def collisions() -> str:
    """Return the table of the collisions in free space."""
    rows = []
    for condition in ("gap", "midpoint", "massless"):
        for friction in (0.0, 0.2):
            for targets in round_targets.TARGETS:
                run = round_targets.collision(targets, condition=condition, friction=friction)
                momentum, angular = round_targets.momentum_changes(run)
                figures = (
                    run.energy("max_defect"),
                    run.energy("normal_contact"),
                    momentum,
                    angular,
                )
                rows.append((condition, friction, targets, *(f"{f:.1e}" for f in figures)))
    head = ("condition", "μ", "targets", "defect / E₀", "normal work / E₀", "momentum", "angular")
    return table(head, rows)


def box() -> str:
    """Return the table of the two balls in a box, without friction, with massless nodes."""
    rows = []
    for targets in round_targets.TARGETS:
        changes = (
            "contact.friction=0",
            "contact.condition=massless",
            f"contact.targets={targets}",
            "output.history_every=2e-3",
        )
        run = simulate(example("two_balls.toml", *changes))
        depth = run.history["penetration"].max()
        figures = (f"{run.energy('max_drift'):.1e}", f"{run.history['min_gap'].min():.1e} m")
        rows.append(
            (targets, *figures, f"{depth:.4f} m", f"{1e3 * run.wall / run.summary['steps']:.2f} ms")
        )
    return table(("targets", "drift / E₀", "least gap", "depth of facets", "step"), rows)


def slide() -> str:
    """Return the table of the sliding ball."""
    rows = []
    for divisions in (6, 10):
        for targets in round_targets.TARGETS:
            run = round_targets.slide(targets, divisions=divisions)
            ripple = f"{100 * round_targets.ripple(run, 1.0, 1):.1f} %"
            rows.append((divisions, targets, ripple, f"{run.wall:.1f} s"))
    return table(("divisions of the ball", "targets", "ripple of the force", "run"), rows)


def roll() -> str:
    """Return the table of the ball on the sphere."""
    rows = []
    for friction in (0.0, 0.5):
        for targets in round_targets.TARGETS:
            run = round_targets.roll(targets, friction=friction)
            ripple = f"{100 * round_targets.ripple(run, 0.15, 4):.1f} %"
            defect = f"{run.energy('max_defect'):.1e}"
            iterations = f"{run.history['newton_iterations'].mean():.1f}"
            rows.append((friction, targets, ripple, defect, iterations))
    return table(("μ", "targets", "ripple of the force", "defect / E₀", "iterations"), rows)


def fits() -> str:
    """Return the table of the shaft in the hub."""
    rows = []
    for discretisation in ("node-to-segment", "mortar"):
        for targets in round_targets.TARGETS:
            errors = [round_targets.fit_error(targets, discretisation, n) for n in (8, 16)]
            rows.append((discretisation, targets, *(f"{100 * error:+.3f} %" for error in errors)))
    return table(("discretisation", "targets", "32 on 48", "64 on 96"), rows)


SECTIONS: dict[str, Callable[[], str]] = {
    "collisions": collisions,
    "box": box,
    "slide": slide,
    "roll": roll,
    "fits": fits,
}


if __name__ == "__main__":
    for name in sys.argv[1:] or SECTIONS:
        print(SECTIONS[name](), end="\n\n", flush=True)
