"""Solvers of Siconos Numerics, run by a Python that has it, each in a process of its own."""

from __future__ import annotations

import json
import math
import shutil
import signal
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from carom.errors import InputError
from carom.friction import siconos_text
from carom.friction.bench.case import Case
from carom.friction.bench.run import BUDGET, FEWEST, MOST, Run

NAME = "Siconos"

DRIVER = Path(__file__).with_name("driver.py")

SOLVERS = {
    2: ("NSGS", "CPG", "LEMKE"),
    3: ("NSGS", "NSN_AC", "NSN_AC-hybrid", "ADMM", "ACLMFP", "PROX", "VI_EG"),
}
"""Its solvers by dimension."""

START_UP = 60.0
"""Wall time that a process may take beside its solves [s]."""


@dataclass(frozen=True)
class Siconos:
    """Siconos, where it is installed.

    Parameters
    ----------
    python
        An interpreter that has the module ``siconos``.
    """

    python: str

    @classmethod
    def find(cls) -> Siconos:
        """Look for it in this Python and in that of the system.

        Raises
        ------
        InputError
            If neither has it.
        """
        pythons = (sys.executable, "/usr/bin/python3", shutil.which("python3"))
        candidates = list(dict.fromkeys(filter(None, pythons)))
        for python in candidates:
            asked = subprocess.run([python, DRIVER], capture_output=True, check=False)
            if asked.returncode == 0:
                return cls(python)
        raise InputError(
            f"no Python here has the module siconos (tried {', '.join(candidates)}); on Debian, "
            "install python3-siconos, or leave out --against siconos"
        )

    def solvers(self, dimension: int) -> tuple[str, ...]:
        """Return the names of the solvers for a dimension."""
        return SOLVERS.get(dimension, ())

    def run(self, case: Case, solver: str, *, tolerance: float, time_limit: float) -> Run:
        """Run a solver from zero, as often as a steady time needs."""
        with tempfile.TemporaryDirectory() as folder:
            problem, answer = Path(folder) / "problem.dat", Path(folder) / "answer.npz"
            siconos_text.write(case.problem, problem)
            order = {
                "problem": str(problem),
                "answer": str(answer),
                "dimension": case.problem.dimension,
                "contacts": case.problem.contacts,
                "solver": solver,
                "tolerance": tolerance,
                "time_limit": time_limit,
                "budget": BUDGET,
                "fewest": FEWEST,
                "most": MOST,
            }
            status = self._status(order, wall=START_UP + 20.0 * (time_limit + BUDGET))
            if status is not None:
                return _unanswered(case, solver, status)
            with np.load(answer) as found:
                reactions, time = found["reactions"], float(np.median(found["times"]))
                claimed, iterations = bool(found["info"] == 0), int(found["iterations"])
        # The system counts processor time in whole seconds.
        if time > time_limit:
            return _unanswered(case, solver, "time-limit")
        measured = case.problem.measure(reactions)
        solved = measured.residual <= tolerance
        return Run(
            case=case.name,
            solver=solver,
            claimed=claimed,
            solved=solved,
            status="solved" if solved else "inexact" if claimed else "failed",
            time=time,
            iterations=iterations,
            residual=measured.residual,
            certificate=measured.certificate,
        )

    def _status(self, order: dict[str, object], *, wall: float) -> str | None:
        """Run the driver; return why it gave no answer, None where it gave one."""
        try:
            done = subprocess.run(
                [self.python, DRIVER, json.dumps(order)],
                capture_output=True,
                timeout=wall,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return "time-limit"
        if done.returncode == 0:
            return None
        return "time-limit" if -done.returncode in {signal.SIGXCPU, signal.SIGKILL} else "crashed"


def _unanswered(case: Case, solver: str, status: str) -> Run:
    return Run(
        case=case.name,
        solver=solver,
        claimed=False,
        solved=False,
        status=status,
        time=math.nan,
        iterations=0,
        residual=math.nan,
        certificate=math.nan,
    )
