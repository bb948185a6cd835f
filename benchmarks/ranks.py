"""What ranks share of a ball impact: processor time and memory of each, and whether results agree.

    .venv-ranks/bin/python benchmarks/ranks.py [divisions] [steps] [ranks]

A ball of hexahedra lands on a floor with friction, by `conserving` and `midpoint`, in steps as long
as a wave needs for a cell. One process without an engine, then so many ranks with ``petsc``: each
twice, for half of the steps and for all, so that the difference is that of steps alone. It runs in
the Python that it is started with, which needs carom, mpi4py and petsc4py.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

from sections.layout import power, table

CASE = """
title = "ball"
dimension = 3
[analysis]
end_time = {end}
time_step = {step}
[output]
fields_every = {end}
[materials.m]
kind = "saint-venant-kirchhoff"
young = 1e4
poisson = 0.3
density = 10.0
[[bodies]]
name = "ball"
material = "m"
velocity = [0.5, 0.0, -2.0]
mesh = {{ kind = "ball", centre = [0.0, 0.0, 0.501], radius = 0.5, divisions = {divisions} }}
[[obstacles]]
kind = "plane"
name = "floor"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
[contact]
friction = 0.2
condition = "midpoint"
"""

RUN = """
import atexit, resource, sys

def tell():
    used = resource.getrusage(resource.RUSAGE_SELF)
    print(f"used {used.ru_utime + used.ru_stime:.1f} {used.ru_maxrss // 1024}", file=sys.__stderr__)

atexit.register(tell)
from carom.cli import main
main()
"""

ENVIRONMENT = {
    "OMP_NUM_THREADS": "1",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
}


def used(case: Path, out: Path, *, ranks: int) -> tuple[float, float, dict[str, float]]:
    """Return processor time [s] and memory [MB] of the busiest process, and energies."""
    command = [sys.executable, "-c", RUN, "run", str(case), "--out", str(out), "--quiet", "--force"]
    if ranks > 1:
        command = ["mpiexec", "-n", str(ranks), *command, "--engine", "petsc"]
    else:
        command += ["--threads", "1"]
    done = subprocess.run(
        command, env=os.environ | ENVIRONMENT, capture_output=True, text=True, check=True
    )
    # What several say at once may stand on one line.
    said = re.findall(r"used ([\d.]+) (\d+)", done.stderr)
    assert len(said) == ranks, done.stderr
    time, memory = (max(float(words[k]) for words in said) for k in (0, 1))
    summary = json.loads((out / "summary.json").read_text(encoding="utf-8"))
    return time, memory, summary["energy"] | {"unknowns": summary["dofs"]}


def main() -> None:
    """Print the table."""
    divisions, steps, ranks = (
        int(x) for x in (*sys.argv[1:], *("46", "20", "2")[len(sys.argv) - 1 :])
    )
    # A wave crosses a cell of the ball in a step.
    step = 2e-4 * 46 / divisions
    rows, energies, whole = [], {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for count in (1, ranks):
            times = []
            for part in (steps // 2, steps):
                case = Path(folder) / "case.toml"
                text = CASE.format(end=part * step, step=step, divisions=divisions)
                case.write_text(text, encoding="utf-8")
                time, memory, energy = used(case, Path(folder) / "out", ranks=count)
                times.append(time)
            energies[count], whole[count] = energy, (times[1], memory)
            per_step = (times[1] - times[0]) / (steps - steps // 2)
            rows.append(
                (
                    f"{count}",
                    f"{times[1]:.0f}",
                    f"{per_step:.2f}",
                    f"{memory:.0f}",
                    f"{energy['final']:.12g}",
                )
            )
    print(f"{energies[1]['unknowns']:,} unknowns, {steps} steps, of each rank:\n")
    print(table(("ranks", "CPU [s]", "CPU per step [s]", "memory [MB]", "energy [J]"), rows))
    difference = abs(energies[1]["final"] - energies[ranks]["final"]) / energies[1]["initial"]
    print(f"\nEnergies differ by {power(difference)} E₀.")


if __name__ == "__main__":
    main()
