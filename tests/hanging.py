"""Cases of bodies that hang on springs and carry masses, in the plane and in space."""

RUBBER = {
    "rubber": {"kind": "neo-hookean", "young": 2e5, "poisson": 0.3, "density": 500.0},
}

PLANE = {
    "title": "hanging in the plane",
    "analysis": {"end_time": 0.4, "time_step": 2e-3, "gravity": [0.0, -9.81]},
    "materials": RUBBER,
    "bodies": [
        {
            "name": "beam",
            "material": "rubber",
            "mesh": {"kind": "rectangle", "corner": [0, 0], "size": [1, 0.1]}
            | {"divisions": [20, 2]},
        },
        {
            "name": "wheel",
            "kind": "rigid",
            "density": 500.0,
            "mesh": {"kind": "disc", "centre": [0.5, 0.5], "radius": 0.15, "divisions": 4},
            "spin": 6.0,
        },
    ],
    "obstacles": [
        {"name": "hoist", "kind": "box", "corner": [-0.1, 0.95], "size": [0.2, 0.05]}
        | {"velocity": [0.0, 0.3]},
    ],
    "springs": [
        {
            "name": "cable",
            "between": [
                {"obstacle": "hoist", "point": [0, 0.95]},
                {"body": "beam", "point": [0, 0.1]},
            ],
            "stiffness": 4e3,
            "damping": 30.0,
        },
        {
            "name": "strut",
            "between": [
                {"body": "wheel", "point": [0.5, 0.4]},
                {"body": "beam", "on": "right"},
            ],
            "stiffness": 2e3,
            "free_length": 0.5,
        },
        {
            "name": "dashpot",
            "between": [{"body": "wheel", "point": [0.6, 0.5]}, {"point": [1.1, 0.7]}],
            "damping": 200.0,
        },
        {
            "name": "hook",
            "between": [{"body": "wheel", "point": [0.5, 0.65]}, {"point": [0.5, 1.0]}],
            "stiffness": 5e3,
        },
    ],
    "masses": [
        {"body": "beam", "on": "left", "mass": 4.0},
        {"body": "wheel", "point": [0.4, 0.5], "mass": 10.0},
    ],
    "output": {"fields_every": 0.02, "history_every": 0.02},
}

SPACE = {
    "title": "hanging in space",
    "dimension": 3,
    "analysis": {"end_time": 0.2, "time_step": 4e-3, "gravity": [0.0, 0.0, -9.81]},
    "materials": RUBBER,
    "bodies": [
        {
            "name": "drum",
            "material": "rubber",
            "mesh": {
                "kind": "cylinder",
                "base": [0, 0, 0],
                "axis": [0, 1, 1],
                "radius": 0.2,
                "height": 0.3,
                "divisions": 2,
                "layers": 2,
            },
            "spin": [0.0, 0.0, 3.0],
        },
        {
            "name": "crate",
            "kind": "rigid",
            "density": 500.0,
            "mesh": {"kind": "box", "corner": [0.6, 0, 0], "size": [0.3, 0.3, 0.3]}
            | {"divisions": [2, 2, 2]},
        },
    ],
    "springs": [
        {
            "name": "hook",
            "between": [{"body": "drum", "on": "top"}, {"point": [0, 0.2, 0.9]}],
            "stiffness": 5e3,
        },
        {
            "name": "link",
            "between": [
                {"body": "drum", "on": "side"},
                {"body": "crate", "point": [0.6, 0.1, 0.2]},
            ],
            "damping": 100.0,
        },
    ],
    "masses": [{"body": "crate", "point": [0.9, 0.3, 0.3], "mass": 5.0}],
    "output": {"fields_every": 0.02, "history_every": 0.02},
}
