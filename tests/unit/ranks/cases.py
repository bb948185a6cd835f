"""Cases that are run on one rank and on several."""

import carom

SOFT = {"kind": "saint-venant-kirchhoff", "young": 2e4, "poisson": 0.3, "density": 10.0}


def discs(**changes):
    """Two discs that meet in the plane, with friction, by the default condition."""

    def disc(name, centre, speed):
        mesh = {"kind": "disc", "centre": centre, "radius": 0.5, "divisions": 4}
        return {"name": name, "material": "m", "velocity": [speed, 0.0], "mesh": mesh}

    case = {
        "analysis": {"end_time": 0.024, "time_step": 2e-3},
        "materials": {"m": SOFT},
        "bodies": [disc("a", [0.0, 0.0], 2.0), disc("b", [1.0, 0.2], -2.0)],
        "contact": {"friction": 0.2},
    }
    return carom.Scenario.from_dict({**case, **changes})


def ball():
    """A ball that lands on a floor in space, so large that a polynomial stands for its factor."""
    mesh = {"kind": "ball", "centre": [0.0, 0.0, 0.51], "radius": 0.5, "divisions": 8}
    case = {
        "dimension": 3,
        "analysis": {"end_time": 0.007, "time_step": 1e-3},
        "materials": {"m": {**SOFT, "young": 1e4}},
        "bodies": [{"name": "a", "material": "m", "velocity": [0.5, 0, -2], "mesh": mesh}],
        "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0, 0], "normal": [0, 0, 1]}],
        "contact": {"friction": 0.2, "condition": "midpoint"},
    }
    return carom.Scenario.from_dict(case)


def pressed():
    """A damped, viscous block of two materials with a mass on it, pressed onto a floor by loads."""
    mesh = {"kind": "rectangle", "corner": [0.0, 0.0], "size": [2.0, 1.0], "divisions": [6, 4]}
    viscous = {**SOFT, "viscosity": {"shear": 20.0, "bulk": 10.0}}
    case = {
        "analysis": {"end_time": 0.02, "time_step": 2e-3, "gravity": [0.0, -9.81]},
        "materials": {"m": {**viscous, "damping": {"mass": 0.5, "stiffness": 1e-4}}},
        "bodies": [{"name": "a", "material": "m", "mesh": mesh}],
        "masses": [{"body": "a", "on": "top", "mass": 3.0}],
        "loads": [{"kind": "pressure", "body": "a", "on": "top", "pressure": "3000*t"}],
        "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}],
        "contact": {"friction": 0.3},
    }
    return carom.Scenario.from_dict(case)


def squeezed():
    """A block that supports squeeze against a wall, by load steps."""
    mesh = {"kind": "box", "corner": [0.0, 0.0, 0.0], "size": [1, 1, 1], "divisions": [3, 3, 3]}
    case = {
        "dimension": 3,
        "analysis": {"kind": "static", "end_time": 1.0, "time_step": 0.5},
        "materials": {"m": {"kind": "neo-hookean", "young": 1e4, "poisson": 0.3, "density": 10.0}},
        "bodies": [{"name": "a", "material": "m", "mesh": mesh}],
        "motions": [
            {"kind": "fixed", "body": "a", "on": "bottom"},
            {"kind": "prescribed", "body": "a", "on": "top", "x": 0, "y": 0, "z": "-0.1*t"},
        ],
        "obstacles": [
            {"kind": "plane", "name": "wall", "point": [1.01, 0, 0], "normal": [-1, 0, 0]}
        ],
        "contact": {"friction": 0.2},
    }
    return carom.Scenario.from_dict(case)
