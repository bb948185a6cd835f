"""Runs one solver of Siconos; a script for a Python that has Siconos but not carom.

The argument is an order as JSON; without one the script only shows that it could run. The answer
is written as NumPy arrays, since Siconos may print what it likes. Only the call of the solver is
timed. The processor time of the first solve is limited by the system, which ends the process. The
script stands in a folder of its own, which Python searches first for modules.
"""

from __future__ import annotations

import json
import math
import os
import resource
import sys
import time
from typing import Any

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[threads] = "1"

import numpy as np  # noqa: E402 (reads the environment when imported)
import siconos.numerics as sn  # noqa: E402

NEWTON_ITERATIONS, ITERATIONS = 10_000, 100_000_000
"""Iterations that the time limit comes before; Newton's method allocates for each."""


def main(order: dict[str, Any]) -> None:
    """Solve the problem of an order repeatedly and write the last answer."""
    size = order["dimension"] * order["contacts"]
    limit_processor_time(order["time_limit"])
    times: list[float] = []
    while not enough(times, order):
        # Solvers may keep factors in the problem, so that each solve gets a new one.
        problem = sn.frictionContact_new_from_filename(order["problem"])
        options, driver = solver_options(order)
        reactions, motions = np.zeros(size), np.zeros(size)
        start = time.perf_counter()
        info = driver(problem, reactions, motions, options)
        times.append(time.perf_counter() - start)
        if len(times) == 1:
            resource.setrlimit(resource.RLIMIT_CPU, (resource.RLIM_INFINITY,) * 2)
    np.savez(
        order["answer"],
        reactions=reactions,
        times=times,
        info=info,
        iterations=options.iparam[sn.SICONOS_IPARAM_ITER_DONE],
    )


def solver_options(order: dict[str, Any]) -> tuple[Any, Any]:
    """Return the options of a solver, and the function that takes them."""
    name, _, variant = order["solver"].partition("-")
    flat = order["dimension"] == 2
    options = sn.SolverOptions(getattr(sn, f"SICONOS_FRICTION_{2 if flat else 3}D_{name}"))
    options.dparam[sn.SICONOS_DPARAM_TOL] = order["tolerance"]
    newton = name.startswith("NSN")
    options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = NEWTON_ITERATIONS if newton else ITERATIONS
    if variant == "hybrid":
        strategy = sn.SICONOS_FRICTION_3D_NSN_HYBRID_STRATEGY
        options.iparam[strategy] = sn.SICONOS_FRICTION_3D_NSN_HYBRID_STRATEGY_VI_EG_NSN
    return options, sn.fc2d_driver if flat else sn.fc3d_driver


def enough(times: list[float], order: dict[str, Any]) -> bool:
    """Whether a solve that took these times has been repeated often enough."""
    total, budget = sum(times), float(order["budget"])
    least = int(order["fewest"] if total >= budget else order["most"])
    return total >= 10.0 * budget or len(times) >= least


def limit_processor_time(seconds: float) -> None:
    """Have the system end this process when it has computed for so long from now on."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    limit = math.ceil(used.ru_utime + used.ru_stime + seconds)
    resource.setrlimit(resource.RLIMIT_CPU, (limit, resource.RLIM_INFINITY))


if __name__ == "__main__" and len(sys.argv) > 1:
    main(json.loads(sys.argv[1]))
