"""Running what measures, and finding numbers in what it says."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

from . import measures
from .manifest import Claim
from .pages import ROOT, Page

Output = str | dict[str, float]


class MissingError(Exception):
    """What a run needs is not on this machine."""


def measure(run: dict[str, Any]) -> Output:
    """Run a command, a function of `measures`, or read a page that a command writes.

    Parameters
    ----------
    run
        ``command`` with ``needs``, environment variables without which it cannot be run;
        ``python``, a function of `measures`; ``page``, a page or a source; or ``blocks``, the code
        on a page and what it prints.

    Raises
    ------
    MissingError
        If something that the command needs is not there.
    subprocess.CalledProcessError
        If the command fails.
    """
    for name in run.get("needs", ()):
        if not os.environ.get(name):
            raise MissingError(f"the environment variable {name} is not set")
    if "page" in run:
        return Page.read(run["page"]).text
    if "blocks" in run:
        return Page.read(run["blocks"]).blocks
    if "python" in run:
        found: dict[str, float] = getattr(measures, run["python"])()
        return found
    # The commands of this environment, whatever else is on the path.
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "COLUMNS": "200"}
    command = run["command"]
    done = subprocess.run(
        command,
        shell=True,
        cwd=ROOT,
        env=environment,
        check=True,
        text=True,
        stdout=subprocess.PIPE,
    )
    return done.stdout


def values(claim: Claim, output: Output) -> list[float]:
    """Return what an output says of the numbers of a claim.

    Raises
    ------
    ValueError
        If an expression is not found, or a name is not there.
    """
    found = []
    for each in claim.gives:
        if isinstance(output, dict):
            if each not in output:
                raise ValueError(f"{claim.run} gives no {each!r}; it gives {', '.join(output)}")
            found.append(output[each])
            continue
        match = re.search(each, output, re.MULTILINE)
        if match is None:
            raise ValueError(f"{claim.run} prints nothing like {each!r}")
        found += [measures.number(group) for group in match.groups()]
    return found
