"""Bodies that are held and moved by supports, for audits."""

import carom

SQUARE = {"kind": "rectangle", "size": [1.0, 0.5], "divisions": [5, 3]}


def held(condition, scheme, **changes):
    """A block whose left side is shaken, under one that is thrown on it and one on rollers."""
    case = {
        "analysis": {
            "end_time": 0.3,
            "time_step": 2e-3,
            "gravity": [0, -9.81],
            "scheme": {"kind": scheme} if isinstance(scheme, str) else scheme,
        },
        "output": {"history_every": 2e-3, "fields_every": 0.02, "audit": True},
        "materials": {
            "m": {
                "kind": "saint-venant-kirchhoff",
                "young": 2e4,
                "poisson": 0.3,
                "density": 10.0,
                "damping": {"mass": 0.5, "stiffness": 1e-4},
            }
        },
        "bodies": [
            {"name": "beam", "material": "m", "mesh": {**SQUARE, "corner": [0.0, 0.0]}},
            {
                "name": "ball",
                "material": "m",
                "mesh": {"kind": "disc", "centre": [0.7, 0.72], "radius": 0.2, "divisions": 4},
                "velocity": [0.3, -1.0],
            },
        ],
        "motions": [
            {
                "kind": "prescribed",
                "body": "beam",
                "on": "left",
                "x": "0.02*sin(20*t)",
                "y": {"time": [0.0, 0.1, 0.4], "value": [0.0, 0.03, -0.03]},
            },
            {"kind": "fixed", "body": "beam", "on": "right", "components": ["y"]},
        ],
        "springs": [
            {
                "name": "stay",
                "between": [{"body": "beam", "on": "left"}, {"body": "ball", "point": [0.7, 0.72]}],
                "stiffness": 10.0,
            }
        ],
        "contact": {"condition": condition, "friction": 0.2, "penetration_tolerance": 0.5},
    }
    return carom.Scenario.from_dict({**case, **changes})
