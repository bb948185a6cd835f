"""Bodies that rub by laws of friction, for audits."""

import carom

LAWS = {
    "static and kinetic": {"static": 0.6, "kinetic": 0.3},
    "Stribeck": {"static": 0.5, "kinetic": 0.2, "speed": 0.1, "viscous": 0.2},
    "weakening": {"static": 0.5, "kinetic": 0.1, "distance": 0.02},
    "rate and state": {
        "reference": 0.3,
        "direct": 0.05,
        "evolution": 0.06,
        "speed": 0.05,
        "distance": 0.01,
    },
    "speed and distance": {"formula": "0.2 + 0.1*exp(-v/0.5) + 0.1*min(s/0.03, 1)"},
    "pressure": {"formula": "min(0.4, 60/p)"},
}


def rubbing(law, condition="midpoint", scheme="conserving", **changes):
    """A soft block on a belt, held by a spring, with a smaller block sliding on it."""
    case = {
        "title": "Rubbing",
        "analysis": {
            "end_time": 0.2,
            "time_step": 2e-3,
            "gravity": [0, -9.81],
            "scheme": {"kind": scheme},
        },
        "output": {"history_every": 2e-3, "fields_every": 2e-3, "audit": True},
        "materials": {
            "soft": {
                "kind": "saint-venant-kirchhoff",
                "young": 2e4,
                "poisson": 0.3,
                "density": 20.0,
                "damping": {"mass": 0.0, "stiffness": 1e-3},
            }
        },
        "bodies": [
            {
                "name": "block",
                "material": "soft",
                "mesh": {
                    "kind": "rectangle",
                    "corner": [0.0, 0.0],
                    "size": [1.0, 0.5],
                    "divisions": [4, 2],
                },
            },
            {
                "name": "rider",
                "material": "soft",
                "velocity": [0.6, 0.0],
                "mesh": {
                    "kind": "rectangle",
                    "corner": [0.23, 0.5],
                    "size": [0.4, 0.2],
                    "divisions": [3, 2],
                },
            },
        ],
        "springs": [
            {
                "name": "spring",
                "between": [{"point": [-1.0, 0.25]}, {"body": "block", "on": "left"}],
                "stiffness": 2000.0,
            }
        ],
        "obstacles": [
            {
                "kind": "plane",
                "name": "belt",
                "point": [0, 0],
                "normal": [0, 1],
                "velocity": [0.3, 0.0],
            }
        ],
        "contact": {"condition": condition, "friction": law, "penetration_tolerance": 0.5},
    }
    return carom.Scenario.from_dict({**case, **changes})
