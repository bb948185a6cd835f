"""What is run, as plain data: whether two runs are of one case, or of bodies that are the same."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from carom._carom import Simulation
from carom.case.obstacle import RigidSurface
from carom.case.scenario import Scenario
from carom.messages import show


def identity(scenario: Scenario, simulation: Simulation) -> dict[str, Any]:
    """Return what two runs must have in common for one to go on where the other stopped.

    Meshes and surfaces out of files count by what is in them, not by where they are. How often
    checkpoints are made, whether there is a report and over how many modes energy is split changes
    no other number and does not count.
    """
    case = what_counts(scenario)
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


def what_counts(scenario: Scenario) -> dict[str, Any]:
    """Return a scenario as plain data, without what changes no number of its results."""
    case: dict[str, Any] = json.loads(scenario.to_json())
    for key in ("checkpoint_every", "modes", "report"):
        case["output"].pop(key, None)
    return case


def what_lasts(identity: Mapping[str, Any]) -> dict[str, Any]:
    """Return what two cases must have in common for one to go on with the state of the other.

    Bodies, obstacles and pairs; what drives them, friction and how motion is computed may be
    others.
    """
    case = identity["case"]
    contact = case["contact"]
    return {
        "meshes": identity["meshes"],
        **{key: case[key] for key in ("dimension", "materials", "obstacles")},
        "bodies": [
            {key: value for key, value in body.items() if key not in ("velocity", "spin")}
            for body in case["bodies"]
        ],
        "contact": {
            **{key: contact[key] for key in ("sources", "targets", "discretisation")},
            "pairs": [
                {key: value for key, value in pair.items() if key not in _OF_FRICTION}
                for pair in contact["pairs"]
                if any(pair[key] != alike for key, alike in _AS_OTHERS.items())
            ],
        },
    }


_OF_FRICTION = ("friction", "resolve_overlap")
"""What a pair may change from one case to the next."""

_AS_OTHERS = {"sources": None, "discretisation": None, "interference": None, "enabled": True}
"""What else a pair has that differs from others in nothing but friction."""


def difference(here: Mapping[str, Any], there: Mapping[str, Any]) -> tuple[str, str] | None:
    """Return the dotted key of the first difference of nested data and what it is, if any."""
    ours, theirs = dict(_leaves(here)), dict(_leaves(there))
    keys = [key for key in {**theirs, **ours} if ours.get(key) != theirs.get(key)]
    if not keys:
        return None
    key = keys[0].removeprefix("case.")
    if key == "meshes":
        what = "the meshes of the bodies are others"
    else:
        now, then = (show(leaves.get(keys[0], "absent")) for leaves in (ours, theirs))
        what = f"{key} = {now}, there it is {then}"
    return key, what + (f" (and {len(keys) - 1} more)" if len(keys) > 1 else "")


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
