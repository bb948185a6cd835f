"""A layer falls obliquely on a rough floor: it sticks, or slips and loses what waves say."""

from pathlib import Path

import carom

SPEED = 0.01  # m/s, v_n
WIDTH = 0.25  # m


def scenario(*, ratio: float = 1.0) -> carom.Scenario:
    """Describe the same as oblique_layer.toml, where v_t / v_n = 1."""
    mesh = carom.Rectangle(
        corner=[0.0, 2.5e-5], size=[WIDTH, 1.0], divisions=[16, 64], periodic=True
    )
    layer = carom.Body(
        name="layer", material="elastic", mesh=mesh, velocity=[ratio * SPEED, -SPEED]
    )
    return carom.Scenario(
        title="Oblique impact of a layer",
        analysis=carom.Dynamic(end_time=1.2, time_step=5e-3),
        output=carom.Output(
            fields_every=0.02,
            history_every=0.01,
            track=[carom.Track(name="sole", body="layer", point=[0.0, 0.0])],
        ),
        materials={"elastic": carom.LinearElastic(young=8 / 3, poisson=1 / 3, density=1.0)},
        bodies=[layer],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
        contact=carom.Contact(condition="massless", friction=0.2),
    )


def main(out: str | Path | None = None) -> None:
    """Run a layer that sticks and two that slip; check the dissipation and the time of contact."""
    for ratio, exact in ((0.2, 0.0), (1.0, 0.24), (2.0, 0.64)):
        directory = Path(out or "results") / f"oblique_layer_{ratio}"
        result = carom.run(scenario(ratio=ratio), out=directory, force=True)
        (contact,) = result.summary["contacts"]
        lost = contact["friction_work"] / WIDTH / SPEED**2
        release = contact["release"]
        assert release is not None, "the layer still touches at the end"
        duration = release - contact["onset"]
        print(f"v_t / v_n = {ratio}: {duration:.3f} s of contact, lost {lost:.4f} v_n² ({exact})")
        assert abs(lost - exact) <= 0.025 * exact + 5e-4
        assert abs(duration - 1.0) <= 1 / 64


if __name__ == "__main__":
    main()
