"""A part that Gmsh meshes with 55,000 nodes of quadratic tetrahedra is dropped on a rigid floor.

Needs Gmsh: pip install "carom[gmsh]".
"""

import argparse
from pathlib import Path

import carom

GEOMETRY = Path(__file__).with_name("bracket.geo")
SPEED = 2.0  # [m/s]


def scenario(geometry: Path = GEOMETRY, *, end_time: float = 3.6e-4) -> carom.Scenario:
    """Describe the bracket just above the floor; its geometry is in millimetres."""
    polymer = carom.NeoHookean(young=2.3e9, poisson=0.35, density=1050.0)
    mesh = carom.MeshFile(file=str(geometry), body="bracket", scale=1e-3)
    bracket = carom.Body(name="bracket", material="polymer", mesh=mesh, velocity=[0.0, 0.0, -SPEED])
    floor = carom.Plane(name="floor", point=[0.0, 0.0, -0.01455], normal=[0.0, 0.0, 1.0])
    return carom.Scenario(
        title="A bracket on the floor",
        dimension=3,
        analysis=carom.Dynamic(end_time=end_time, time_step=4e-6, scheme=carom.Theta()),
        output=carom.Output(fields_every=2e-5),
        materials={"polymer": polymer},
        bodies=[bracket],
        obstacles=[floor],
        contact=carom.Contact(condition="gap", friction=0.2),
    )


def main(out: str | Path | None = None, geometry: Path = GEOMETRY) -> None:
    """Drop the bracket; check when it touches and that no energy comes from nowhere."""
    result = carom.run(scenario(geometry), out=out, force=True)
    energy, contacts = result.summary["energy"], result.summary["contacts"]
    print(
        f"{result.summary['dofs']} dofs, {result.summary['steps']} steps, "
        f"{result.summary['wall_s']:.0f} s; first contact at {contacts[0]['onset'] * 1e6:.0f} µs, "
        f"peak force {max(c['peak_force'] for c in contacts):.0f} N, "
        f"friction took {100 * energy['friction'] / energy['initial']:.1f} % of the energy"
    )
    assert contacts[0]["onset"] < 1e-4
    assert 0.8 * energy["initial"] < energy["final"] <= 1.001 * energy["initial"]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path)
    main(parser.parse_args().out)
