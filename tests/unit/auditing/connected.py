"""Bodies that springs, dampers and masses at points connect, for audits."""

import carom

SQUARE = {"kind": "rectangle", "size": [1.0, 1.0], "divisions": [3, 3]}
ROPE = {"elongation": [-1.0, 0.0, 1.0], "force": [0.0, 0.0, 80.0]}


def connected(condition, scheme, **changes):
    """A soft block with masses on top, a rigid one hung by a rope and a strut, a belt that pulls.

    Five springs: a rope between bodies, a strut to the ground, a damper to the belt, a stiff spring
    within the soft block, and one from a set to a point.
    """
    case = {
        "title": "Connected",
        "analysis": {
            "end_time": 0.4,
            "time_step": 4e-3,
            "gravity": [0, -9.81],
            "scheme": {"kind": scheme} if isinstance(scheme, str) else scheme,
        },
        "output": {"history_every": 4e-3, "fields_every": 0.04, "audit": True},
        "materials": {
            "soft": {"kind": "neo-hookean", "young": 5e3, "poisson": 0.3, "density": 1.0}
        },
        "bodies": [
            {"name": "soft", "material": "soft", "mesh": {**SQUARE, "corner": [0.0, 0.01]}},
            {
                "kind": "rigid",
                "name": "hard",
                "mass": 0.5,
                "mesh": {**SQUARE, "corner": [1.2, 0.5]},
                "spin": 1.0,
            },
        ],
        "masses": [
            {"body": "soft", "on": "top", "mass": 0.5},
            {"body": "hard", "point": [1.9, 1.2], "mass": 0.2},
        ],
        "springs": [
            {
                "name": "rope",
                "between": [{"body": "soft", "on": "right"}, {"body": "hard", "point": [2, 1]}],
                "force": ROPE,
                "damping": 0.2,
            },
            {
                "name": "strut",
                "between": [{"body": "hard", "point": [1.8, 0.9]}, {"point": [3.0, 4.0]}],
                "stiffness": 20.0,
            },
            {
                "name": "brake",
                "between": [
                    {"obstacle": "floor", "point": [0.2, 0]},
                    {"body": "soft", "on": "top"},
                ],
                "damping": 0.3,
            },
            {
                "name": "tie",
                "between": [
                    {"body": "soft", "point": [0.0, 1.0]},
                    {"body": "soft", "point": [1.0, 0.0]},
                ],
                "stiffness": 300.0,
                "free_length": 1.2,
            },
        ],
        "obstacles": [
            {
                "kind": "plane",
                "name": "floor",
                "point": [0, 0],
                "normal": [0, 1],
                "velocity": [0.5, 0.0],
            }
        ],
        "contact": {"condition": condition, "friction": 0.3, "penetration_tolerance": 0.5},
    }
    return carom.Scenario.from_dict({**case, **changes})
