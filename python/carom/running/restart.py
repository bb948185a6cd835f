"""Going on with a run that was stopped: which checkpoint, and whether it is of this case."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from carom._carom import Simulation
from carom.case.obstacle import RigidSurface
from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.io import layout
from carom.io.checkpoint import Checkpoint, DamagedError, read_checkpoint
from carom.io.progress import refuse_running
from carom.io.summary import read_summary
from carom.messages import show
from carom.results.doubts import Doubt
from carom.results.result import Result, read_case
from carom.running.recorder import conclude

Notify = Callable[[Doubt], None]
"""What is told that the user should know something."""


def identity(scenario: Scenario, simulation: Simulation) -> dict[str, Any]:
    """Return what two runs must have in common for one to go on where the other stopped.

    Meshes and surfaces out of files count by what is in them, not by where they are. How often
    checkpoints are made and whether there is a report changes no number and does not count.
    """
    case = _what_counts(scenario)
    for index, obstacle in enumerate(scenario.obstacles):
        if isinstance(obstacle, RigidSurface):
            content = Path(obstacle.file).read_bytes()
            case["obstacles"][index]["file"] = hashlib.sha256(content).hexdigest()
    for body in case["bodies"]:
        body["mesh"].pop("file", None)
    mesh = hashlib.sha256()
    for _, array in sorted(simulation.mesh().items()):
        mesh.update(array.tobytes())
    return {"case": case, "meshes": mesh.hexdigest()}


def ended(directory: Path, scenario: Scenario) -> Result | None:
    """Return the results of a run of this scenario that has ended; None if there is more to do.

    Raises
    ------
    InputError
        The results are of another case.
    """
    try:
        status = read_summary(directory / layout.SUMMARY)["status"]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    if status not in layout.ENDED:
        return None
    refuse_other_results(directory, scenario)
    if (directory / layout.PROGRESS).exists():  # stopped in the middle of its last files
        refuse_running(directory)
        return conclude(directory, reports=scenario.output.report)
    return Result.open(directory)


def latest(
    directory: Path, case: Mapping[str, Any], simulation: Simulation, notify: Notify
) -> Checkpoint | None:
    """Restore the last good checkpoint of a directory and return it; None if there never was one.

    Raises
    ------
    InputError
        It is of another case, or there is none that is whole.
    """
    damaged: list[tuple[Path, str]] = []
    for name in (layout.CHECKPOINT, layout.FRESH_CHECKPOINT, layout.PREVIOUS_CHECKPOINT):
        try:
            checkpoint = read_checkpoint(directory / name)
            _refuse_another(directory, dict(case), checkpoint.case)
            simulation.restore(checkpoint.arrays)
        except FileNotFoundError:
            continue
        except DamagedError as error:
            damaged.append((directory / name, str(error)))
        except ValueError as error:
            if isinstance(error, InputError):
                raise
            damaged.append((directory / name, f"{directory / name} does not fit: {error}"))
        else:
            for file, wrong in damaged:
                notify(
                    Doubt(
                        "checkpoint-damaged",
                        f"{wrong}; goes on from the checkpoint at t = {checkpoint.time:g} s",
                        str(file),
                    )
                )
            return checkpoint
    if damaged:
        raise InputError(
            f"{damaged[0][1]}, and there is no other that is whole; start again with --force"
        )
    return None


def refuse_other_results(directory: Path, scenario: Scenario) -> None:
    """Refuse a directory with results that are not the beginning of this run.

    Raises
    ------
    InputError
        They are of another case.
    """
    if not layout.has_results(directory) or not (directory / layout.CASE).exists():
        return
    here, there = (_what_counts(case) for case in (scenario, read_case(directory)))
    _refuse_another(directory, here, there)


def _what_counts(scenario: Scenario) -> dict[str, Any]:
    """Return a scenario as plain data, without what changes no number of its results."""
    case: dict[str, Any] = json.loads(scenario.to_json())
    for key in ("checkpoint_every", "report"):
        case["output"].pop(key, None)
    return case


def _refuse_another(directory: Path, here: dict[str, Any], there: Mapping[str, Any]) -> None:
    """Refuse to go on with a run of another case, and say where they differ."""
    ours, theirs = dict(_leaves(here)), dict(_leaves(there))
    keys = [key for key in {**theirs, **ours} if ours.get(key) != theirs.get(key)]
    if not keys:
        return
    key = keys[0].removeprefix("case.")
    if key == "meshes":
        what = "the meshes of the bodies are others"
    else:
        now, then = (show(leaves.get(keys[0], "absent")) for leaves in (ours, theirs))
        what = f"{key} = {now}, there it is {then}"
    more = f" (and {len(keys) - 1} more)" if len(keys) > 1 else ""
    raise InputError(
        f"{directory} is the run of another case: {what}{more}; give that case, "
        "or choose another --out",
        key,
    )


def _leaves(value: object, key: str = "") -> Iterator[tuple[str, object]]:
    """Yield the values of nested tables and lists with their dotted keys."""
    entries: Iterator[tuple[object, object]] | None = None
    if isinstance(value, Mapping):
        entries = iter(value.items())
    elif isinstance(value, list):
        entries = iter(enumerate(value))
    if entries is None:
        yield key, value
        return
    for name, member in entries:
        yield from _leaves(member, f"{key}.{name}" if key else str(name))
