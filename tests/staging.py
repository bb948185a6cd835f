"""What tests of stages share: a joint that is pressed, hit from the side, and comes to rest."""

import copy

import carom

CASE = {
    "title": "Joint",
    "materials": {
        "steel": {"kind": "linear-elastic", "young": 210e9, "poisson": 0.3, "density": 7800.0}
    },
    "bodies": [
        {
            "name": name,
            "material": "steel",
            "mesh": {"kind": "rectangle", "corner": corner, "size": size, "divisions": divisions},
        }
        for name, corner, size, divisions in (
            ("base", [0.0, 0.0], [0.10, 0.02], [10, 2]),
            ("lid", [0.02, 0.02], [0.06, 0.02], [7, 2]),
        )
    ],
    "contact": {"friction": 0.3},
    "motions": [{"kind": "fixed", "body": "base", "on": "bottom"}],
    "stages": [
        {
            "name": "preload",
            "analysis": {"kind": "static", "end_time": 1.0, "time_step": 0.5},
            "loads": [
                {"kind": "pressure", "body": "lid", "on": "top", "pressure": "1e7*min(t, 1)"}
            ],
        },
        {
            "name": "hit",
            "analysis": {"end_time": 1.00004, "time_step": 5e-7},
            "loads": [
                {
                    "kind": "traction",
                    "body": "lid",
                    "on": "left",
                    "traction": ["3e7*sin(pi*(t - 1)/2e-5)*step(1.00002 - t)", 0.0],
                }
            ],
        },
        {"name": "rest", "analysis": {"kind": "static", "end_time": 2.00004, "time_step": 1.0}},
    ],
}
"""2 + 80 + 1 steps."""


def case():
    return copy.deepcopy(CASE)


def scenario(*overrides):
    return carom.Scenario.from_dict(case()).with_overrides(overrides)
