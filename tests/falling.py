"""Cases of what falls: a ball in space, a disc in the plane, blocks in both."""

BALL = {
    "title": "ball",
    "dimension": 3,
    "analysis": {"end_time": 4e-3, "time_step": 1e-3, "scheme": {"kind": "theta"}},
    "materials": {"rubber": {"kind": "neo-hookean", "young": 1e4, "poisson": 0.3, "density": 1.0}},
    "bodies": [
        {
            "name": "ball",
            "material": "rubber",
            "mesh": {
                "kind": "ball",
                "centre": [0, 0, 1.001],
                "radius": 1,
                "divisions": 2,
                "cell": "hex20",
            },
            "velocity": [0, 0, -1.0],
        }
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0, 0], "normal": [0, 0, 1]}],
    "output": {"fields_every": 2e-3},
}

DISC = {
    "analysis": {"end_time": 0.4, "time_step": 4e-3},
    "output": {"fields_every": 0.1},
    "materials": BALL["materials"],
    "bodies": [
        {
            "name": "disc",
            "material": "rubber",
            "mesh": {"kind": "disc", "centre": [0, 1.05], "radius": 1, "divisions": 4},
            "velocity": [0.3, -1.0],
        }
    ],
    "obstacles": [{"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]}],
    "contact": {"friction": 0.2},
}


def block(dimension, size=0.2):
    """A small block above obstacles that are large, or far away."""
    low = [-size / 2] * dimension
    low[-1] = 0.01
    shape = "box" if dimension == 3 else "rectangle"
    down = [0.0] * (dimension - 1)
    step = 5e-3 * size
    return {
        **BALL,
        "dimension": dimension,
        "analysis": {**BALL["analysis"], "end_time": 4 * step, "time_step": step},
        "output": {"fields_every": 2 * step},
        "bodies": [
            {
                **BALL["bodies"][0],
                "mesh": {"kind": shape, "corner": low, "size": [size] * dimension}
                | {"divisions": [2] * dimension},
                "velocity": [*down, -1.0],
            }
        ],
        "obstacles": [
            {"name": "globe", "kind": "sphere", "centre": [*down, -1.0], "radius": 1.0},
            {"name": "floor", "kind": "plane", "point": [*down, -9.0], "normal": [*down, 1.0]},
        ],
    }
