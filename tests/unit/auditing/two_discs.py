"""The case that audits are tested with, and its results in memory."""

import copy
import json

import carom
from carom.auditing.records.files import Files

LAYER = {
    "name": "b",
    "material": "m",
    "mesh": {
        "kind": "rectangle",
        "corner": [-2.0, 0.005],
        "size": [8.0, 0.2],
        "divisions": [40, 4],
        "periodic": True,
    },
    "velocity": [0.5, 0.0],
}
"""An endless layer in the place of the second disc."""


FLOOR = {
    "name": "floor",
    "kind": "plane",
    "point": [0, 0],
    "normal": [0, 1],
    "velocity": [0.5, 0.1],
}


def scenario(condition="gap", scheme="theta", **changes):
    """Two coarse discs that meet and fall on a floor that moves, with friction: 90 steps.

    No more of them are stored than are needed: most tests audit all of these again.
    """
    case = {
        "title": "Two discs",
        "analysis": {"end_time": 0.18, "time_step": 2e-3, "scheme": {"kind": scheme}},
        "output": {
            "audit": True,
            "fields_every": 0.06,
            "track": [{"name": "tip", "body": "a", "point": [0, 2]}],
        },
        "materials": {
            "m": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1}
        },
        "bodies": [
            {
                "name": "a",
                "material": "m",
                "mesh": {"kind": "disc", "centre": [0, 1.05], "radius": 1, "divisions": 4},
                "velocity": [3, -1],
                "spin": 0.5,
            },
            {
                "name": "b",
                "material": "m",
                "mesh": {"kind": "disc", "centre": [2.1, 1.3], "radius": 1, "divisions": 6},
                "velocity": [-3, -2],
            },
        ],
        "obstacles": [FLOOR],
        "contact": {"condition": condition, "friction": 0.2},
    }
    return carom.Scenario.from_dict(case).with_overrides(
        f"{key}={json.dumps(value, separators=(',', '='))}" for key, value in changes.items()
    )


class InMemory(Files):
    """Results that were read, whose summary and tables can be changed."""

    def __init__(self, files):
        self.__dict__.update(files.__dict__)
        self._models = files.models()
        self._states = list(files.frames()), list(files.surface_frames()), list(files.steps())

    def models(self):
        return self._models

    def frames(self):
        return iter(self._states[0])

    def surface_frames(self):
        return iter(self._states[1])

    def steps(self):
        return iter(self._states[2])

    def changed(self, **parts):
        """Return a copy in which these attributes are others."""
        other = copy.copy(self)
        other.__dict__.update(parts)
        return other
