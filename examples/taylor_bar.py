"""Taylor's anvil test on a row of meshes, as a body of revolution and in space.

The case is `taylor_bar.toml`. What is compared with published lengths of 21.4 to 21.5 mm and radii
of 7.0 to 7.2 mm: the height of the tail over the wall, on which the foot stands in its middle, and
the radius of the rim of the foot. The rim has left the wall, so that it is no measure of length.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import carom

LENGTH, RADIUS, SPEED = 32.4e-3, 3.2e-3, 227.0
CASE = Path(__file__).with_name("taylor_bar.toml")


@dataclass(frozen=True)
class Bar:
    """What is left: length [m], radius of the foot [m], lift of its rim [m], and energies [J]."""

    length: float
    radius: float
    lift: float
    plastic: float
    initial: float
    defect: float
    iterations: float  # per step


def plane(across: int, along: int, time_step: float) -> carom.Scenario:
    """Describe the bar as a body of revolution, `across` × `along` cells."""
    given = [f"bodies.0.mesh.divisions=[{across}, {along}]", f"analysis.time_step={time_step}"]
    return carom.Scenario.from_toml(CASE).with_overrides(given)


def space(across: int, along: int, time_step: float) -> carom.Scenario:
    """Describe the bar in hexahedra, `across` of them along the radius."""
    flat = plane(across, along, time_step)
    mesh = carom.Cylinder(
        base=[0.0, 0.0, 0.0],
        axis=[0.0, 0.0, 1.0],
        radius=RADIUS,
        height=LENGTH,
        divisions=across,
        layers=along,
    )
    bar = carom.Body(
        name="bar",
        material="copper",
        formulation="mean-dilatation",
        mesh=mesh,
        velocity=[0.0, 0.0, -SPEED],
    )
    tracks = [
        carom.Track(name="tail", body="bar", point=[0.0, 0.0, LENGTH]),
        carom.Track(name="foot", body="bar", point=[RADIUS, 0.0, 0.0]),
    ]
    return carom.Scenario(
        title=flat.title,
        dimension=3,
        analysis=flat.analysis,
        output=carom.Output(fields_every=80e-6, history_every=1e-6, track=tracks),
        materials=flat.materials,
        bodies=[bar],
        obstacles=[carom.Plane(name="wall", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
        contact=flat.contact,
    )


def strike(scenario: carom.Scenario) -> Bar:
    """Let the bar strike the wall."""
    up = "y" if scenario.dimension == 2 else "z"
    with tempfile.TemporaryDirectory() as folder:
        result = carom.run(scenario, out=Path(folder) / "results")
    last = {name: float(values[-1]) for name, values in result.history.items()}
    energy = result.summary["energy"]
    return Bar(
        length=LENGTH + last[f"tail.u_{up}"],
        radius=RADIUS + last["foot.u_x"],
        lift=last[f"foot.u_{up}"],
        plastic=energy["plastic"],
        initial=energy["initial"],
        defect=energy["max_defect"],
        iterations=result.summary["newton_iterations"] / result.summary["steps"],
    )


def main(out: str | Path | None = None, *, fine: bool = "--fine" in sys.argv) -> None:
    """Print length and radius on a row of meshes, with --fine on a longer one; check them."""
    del out
    rows = [(plane, 2, 20, 2e-7), (plane, 4, 40, 1e-7), (plane, 6, 60, 0.5e-7)]
    if fine:
        rows += [(plane, 8, 80, 0.4e-7)]
    rows += [(space, 2, 20, 2e-7)]
    print(
        "bar            cells  length [mm] radius [mm] lift [mm] plastic [J] defect [J] iterations"
    )
    for describe, across, along, time_step in rows:
        bar = strike(describe(across, along, time_step))
        kind = "of revolution" if describe is plane else "in space"
        print(
            f"{kind:13} {across} × {along} {bar.length * 1e3:10.3f} {bar.radius * 1e3:11.3f} "
            f"{bar.lift * 1e3:9.3f} {bar.plastic:11.2f} {bar.defect:10.1e} {bar.iterations:10.1f}"
        )
        assert 21.4e-3 < bar.length < 21.5e-3
        assert bar.plastic > 0.98 * bar.initial
        assert bar.defect < 1e-9 * bar.initial


if __name__ == "__main__":
    main()
