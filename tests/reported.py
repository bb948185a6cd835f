"""The case whose report tests look at: a disc that is thrown at a floor."""

DISC = {
    "title": "disc",
    "analysis": {"end_time": 0.4, "time_step": 2e-3, "scheme": {"kind": "theta"}},
    "materials": {
        "rubber": {
            "kind": "saint-venant-kirchhoff",
            "young": 2700.0,
            "poisson": 0.33,
            "density": 1.0,
        }
    },
    "bodies": [
        {
            "name": "disc",
            "material": "rubber",
            "mesh": {"kind": "disc", "centre": [0, 1.2], "radius": 1, "divisions": 4},
            "velocity": [0.5, -2.0],
        }
    ],
    "obstacles": [
        {"name": "floor", "kind": "plane", "point": [0, 0], "normal": [0, 1]},
        {"name": "lift", "kind": "box", "corner": [3, 0], "size": [1, 1], "velocity": [0.5, 0]},
        {
            "name": "swing",
            "kind": "sphere",
            "centre": [-3, 1],
            "radius": 0.5,
            "motion": {"x": "0.3*sin(4*t)", "y": {"time": [0, 0.2], "value": [0, 0.1]}},
        },
        {"name": "ramp", "kind": "polygon", "points": [[4, 3], [6, 2], [5, 2.2], [4, 2]]},
    ],
    "contact": {"friction": 0.2},
    "output": {"fields_every": 0.02, "report": True},
}
