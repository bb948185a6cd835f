"""How fast a block creeps that should stick: on an incline of 10 degrees with a friction of 0.5.

    pip install mujoco ipctk
    .venv/bin/python benchmarks/creep.py

carom: a block of cells, damped in its stiffness, after it has come to rest. MuJoCo: a rigid box
with the defaults of the program, after the same time. IPC: the speed at which the smoothed friction
of IPC Toolkit bears the weight, with the usual ε_v of 1e-3 m/s and with one a hundred times less.
"""

from __future__ import annotations

import importlib

import numpy as np

import carom

ANGLE = np.radians(10.0)
FRICTION = 0.5
GRAVITY = 9.81
END = 5.0


def main() -> None:
    """Print a table."""
    print(f"{'code':28} {'creep [m/s]':>12}")
    for name, creep in (
        ("carom, in the plane", lambda: ours(2)),
        ("carom, in space", lambda: ours(3)),
        ("MuJoCo", mujoco),
        ("IPC, ε_v = 1e-3 m/s", lambda: ipc(1e-3)),
        ("IPC, ε_v = 1e-5 m/s", lambda: ipc(1e-5)),
    ):
        try:
            print(f"{name:28} {abs(creep()):12.1e}")
        except ModuleNotFoundError as missing:
            print(f"{name:28} not run: pip install {missing.name}")


def incline(dimension: int, angle: float, friction: float, end: float) -> carom.Simulation:
    """Return the run of a damped block of cells on a slope of this angle [rad], at its end [s]."""
    up = [0.0] * (dimension - 1)
    down = [GRAVITY * np.sin(angle), *up[1:], -GRAVITY * np.cos(angle)]
    rubber = {
        "kind": "neo-hookean",
        "young": 1e7,
        "poisson": 0.3,
        "density": 1000.0,
        "damping": {"stiffness": 1e-3},
    }
    mesh = {
        "kind": "rectangle" if dimension == 2 else "box",
        "corner": [*up, 0.0],
        "size": [0.4] * (dimension - 1) + [0.2],
        "divisions": [4] * (dimension - 1) + [2],
    }
    slope = {"name": "slope", "kind": "plane", "point": [*up, 0.0], "normal": [*up, 1.0]}
    scenario = carom.Scenario.from_dict(
        {
            "dimension": dimension,
            "analysis": {"end_time": end, "time_step": 2e-3, "gravity": down},
            "materials": {"rubber": rubber},
            "bodies": [{"name": "block", "material": "rubber", "mesh": mesh}],
            "obstacles": [slope],
            "contact": {"friction": friction},
        }
    )
    simulation = carom.Simulation(scenario)
    while simulation.time < end - 1e-9:
        simulation.step()
    return simulation


def ours(dimension: int) -> float:
    """Return the speed of a block of cells over the last second [m/s]."""
    simulation = incline(dimension, ANGLE, FRICTION, END)
    time, x = (np.asarray(simulation.history[name]) for name in ("time", "block.x"))
    start = np.searchsorted(time, END - 1.0)
    return float((x[-1] - x[start]) / (time[-1] - time[start]))


def mujoco() -> float:
    """Return the speed of a rigid box over the last second [m/s]."""
    engine = importlib.import_module("mujoco")
    gravity = f"{GRAVITY * np.sin(ANGLE)} 0 {-GRAVITY * np.cos(ANGLE)}"
    model = engine.MjModel.from_xml_string(f"""
        <mujoco><option gravity="{gravity}"/><worldbody>
        <geom type="plane" size="9 9 1" friction="{FRICTION}"/>
        <body pos="0 0 0.1"><freejoint/>
        <geom type="box" size="0.2 0.2 0.1" density="1000" friction="{FRICTION}"/></body>
        </worldbody></mujoco>""")
    data = engine.MjData(model)
    while data.time < END - 1.0:
        engine.mj_step(model, data)
    start, time = float(data.qpos[0]), data.time
    while data.time < END:
        engine.mj_step(model, data)
    return (float(data.qpos[0]) - start) / (data.time - time)


def ipc(least_speed: float) -> float:
    """Return the speed at which smoothed friction bears the weight [m/s]."""
    toolkit = importlib.import_module("ipctk")
    share, low, high = np.tan(ANGLE) / FRICTION, 0.0, least_speed
    for _ in range(100):
        speed = 0.5 * (low + high)
        bears = toolkit.smooth_friction_f1(speed, least_speed) >= share
        low, high = (low, speed) if bears else (speed, high)
    return high


if __name__ == "__main__":
    main()
