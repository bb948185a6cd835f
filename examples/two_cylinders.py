"""Two elastic cylinders in a rigid box: friction delays their meeting."""

from pathlib import Path

import carom


def cylinder(name: str, *, centre: list[float], velocity: list[float] | None = None) -> carom.Body:
    """Describe a cylinder of radius 1 m."""
    mesh = carom.Disc(centre=centre, radius=1.0, divisions=8)
    return carom.Body(name=name, material="elastic", mesh=mesh, velocity=velocity)


def scenario(*, friction: float) -> carom.Scenario:
    """Describe the same as two_cylinders.toml; the box and the centres are inferred."""
    elastic = carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)
    return carom.Scenario(
        title="Two cylinders in a rigid box",
        analysis=carom.Dynamic(end_time=15.0, time_step=1e-3, scheme=carom.Theta()),
        output=carom.Output(fields_every=0.05, history_every=0.01),
        materials={"elastic": elastic},
        bodies=[
            cylinder("left", centre=[2.0, 4.0], velocity=[1.0, -2.0]),
            cylinder("right", centre=[6.0, 4.0]),
        ],
        obstacles=[
            carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0]),
            carom.Plane(name="east", point=[8.0, 0.0], normal=[-1.0, 0.0]),
            carom.Plane(name="ceiling", point=[0.0, 8.0], normal=[0.0, -1.0]),
            carom.Plane(name="west", point=[0.0, 0.0], normal=[1.0, 0.0]),
        ],
        contact=carom.Contact(
            condition="gap", targets="faceted", sources="finer", friction=friction
        ),
    )


def meeting(result: carom.Result) -> float:
    """Return when the cylinders first touch each other [s]."""
    contacts = result.summary["contacts"]
    return min(c["onset"] for c in contacts if set(c["pair"]) == {"left", "right"})


def main(out: str | Path | None = None) -> None:
    """Run until the cylinders have met, without and with friction (paper: 2.45 s and 2.8 s)."""
    for friction, expected in ((0.0, 2.49), (0.2, 2.83)):
        short = scenario(friction=friction).with_overrides(["analysis.end_time=3.2"])
        directory = Path(out or "results") / f"two_cylinders_friction_{friction}"
        time = meeting(carom.run(short, out=directory, force=True))
        print(f"friction {friction}: the cylinders meet at {time:.3f} s")
        assert abs(time - expected) <= 0.03


if __name__ == "__main__":
    main()
