"""The codes that take part: what they are called, how to get them, what they run."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass


def _carom_is_there(python: str) -> bool:
    return _imports(python, "carom")


def _kratos_is_there(python: str) -> bool:
    return _imports(
        python,
        "KratosMultiphysics.ContactStructuralMechanicsApplication",
        "KratosMultiphysics.LinearSolversApplication",
    )


def _calculix_is_there(_python: str) -> bool:
    return shutil.which("ccx") is not None


def _imports(python: str, *modules: str) -> bool:
    """Return whether there is such an interpreter and it imports these modules."""
    if shutil.which(python) is None:
        return False
    command = [python, "-c", f"import {', '.join(modules)}"]
    return subprocess.run(command, capture_output=True, check=False).returncode == 0


@dataclass(frozen=True)
class Code:
    """A code that can be run.

    Parameters
    ----------
    title
        Its name in tables.
    variants
        Its methods: what `compare.codes` calls them, and what tables do.
    frictions
        Coefficients of friction for which there is an input, by problem.
    is_there
        Whether it is installed, for this Python interpreter.
    install
        How to install it.
    """

    title: str
    variants: dict[str, str]
    frictions: dict[str, tuple[float, ...]]
    is_there: Callable[[str], bool]
    install: str


CODES = {
    "carom": Code(
        title="carom",
        variants={
            "theta/gap": "`theta`, `gap`",
            "conserving/midpoint": "`conserving`, `midpoint`",
        },
        frictions={"cylinders": (0.0, 0.2), "bars": (0.0,)},
        is_there=_carom_is_there,
        install="pip install . in the root of the repository",
    ),
    "kratos": Code(
        title="Kratos",
        variants={"alm": "Bossak, mortar, augmented Lagrangian"},
        frictions={"cylinders": (0.0, 0.2), "bars": (0.0,)},
        is_there=_kratos_is_there,
        install="pip install KratosMultiphysics KratosStructuralMechanicsApplication "
        "KratosContactStructuralMechanicsApplication KratosLinearSolversApplication "
        "(10.4.4 is known to work), here or in the environment of --kratos-python",
    ),
    "calculix": Code(
        title="CalculiX",
        variants={"hht": "HHT α = −0.05, penalty, one layer of bricks"},
        frictions={"cylinders": (0.0,), "bars": (0.0,)},
        is_there=_calculix_is_there,
        install="put ccx on the PATH, for instance by apt-get install calculix-ccx",
    ),
}
