"""A stand-in for the native simulation: enough for the run loop, and no mechanics."""

import copy
import json

import numpy as np

from carom.io.ledger import COLUMNS as LEDGER_COLUMNS
from carom.io.summary_types import EnergySummary

MESH = {
    "points": np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0]]),
    "connectivity": np.array([0, 1, 2, 3, 1, 4, 2], dtype=np.int64),
    "offsets": np.array([0, 4, 7], dtype=np.int64),
    "types": np.array([9, 5], dtype=np.uint8),
    "body": np.array([0, 1], dtype=np.int32),
}


def made_up_fields(time):
    """Fields on MESH that differ in every value and every frame."""
    values = np.arange(10.0).reshape(5, 2) + 100 * time
    return {
        "displacement": values / 3,
        "velocity": -values / 7,
        "reaction": values * 1e-30,
        "stress": np.arange(12.0).reshape(2, 6) + time,
        "strain": np.arange(12.0).reshape(2, 6) * 1e-3,
        "energy_density": np.array([time, 2 * time]),
        "plastic_strain": np.array([0.0, time]),
    }


COLUMNS = (
    "time",
    "kinetic",
    "strain",
    "total",
    "friction",
    "plastic",
    "contacts",
    "tip.u_x",
    "tip.u_y",
    "tip.v_x",
    "tip.v_y",
    "tip.vmid_x",
    "tip.vmid_y",
    "springs",
    "dampers",
)


class FallingSimulation:
    """What the run loop needs of carom.Simulation, on MESH."""

    def __init__(self, scenario, *, stop_at=None, stop=None, certificate=0.0):
        self._certificate = certificate
        self._analysis = json.loads(scenario.to_json())["analysis"]
        self._stop_at, self._stop = stop_at, stop
        self._rows = [self._row(0.0)]
        self.step = 0

    @property
    def steps(self):
        return round(self._analysis["end_time"] / self._analysis["time_step"])

    @property
    def time(self):
        return self.step * self._analysis["time_step"]

    def _row(self, time):
        kinetic = 8.0 * np.cos(time) ** 2
        return [
            time,
            kinetic,
            8.0 - kinetic,
            8.0,
            time / 3,
            0.0,
            1,
            *np.sin(time + np.arange(6)),
            0.0,
            0.0,
        ]

    def describe(self):
        materials = [{"wave_speed": 100.0}]
        bodies = [{"wave_speed": 100.0, "diameter": 2.0, "materials": materials}] * 2
        return {"suggested_time_step": self._analysis["time_step"], "bodies": bodies}

    def mesh(self):
        return copy.deepcopy(MESH)

    def fields(self):
        return made_up_fields(self.time)

    def surface(self):
        return {
            "points": MESH["points"].copy(),
            "connectivity": np.array([0, 1, 1, 4], dtype=np.int64),
            "offsets": np.array([0, 2, 4], dtype=np.int64),
            "types": np.array([3, 3], dtype=np.uint8),
            "body": np.array([0, 1], dtype=np.int32),
        }

    def surface_fields(self):
        return {
            "displacement": self.fields()["displacement"],
            "friction_energy": np.array([self.time, 0.0]),
            "slip": np.array([0.0, self.time]),
            "pressure": np.array([0.0, self.time]),
            "area": np.ones(2),
        }

    def ledger_entry(self, number):
        return ["left", "left|floor"][number]

    def take_ledger(self):
        of_body = {
            "kinetic": 1,
            "strain": 2,
            "external": 3,
            "prescribed": 10,
            "contact": 6,
            "connections": 0,
            "viscous": 4,
            "plastic": 0,
            "scheme": 5,
            "defect": 7,
        }
        of_pair = {"prescribed": 10, "friction": 8, "normal_contact": 9}
        body, pair = (
            [self.time, number, *(terms.get(column, np.nan) for column in LEDGER_COLUMNS[2:])]
            for number, terms in enumerate((of_body, of_pair))
        )
        return np.array([body, pair], dtype=float)

    def history_columns(self):
        return list(COLUMNS)

    def take_history(self):
        rows, self._rows = self._rows, []
        return np.array(rows).reshape(-1, len(COLUMNS))

    def advance(self, until, budget):
        for _ in range(3):  # a budget that always ends after three steps
            if self.time >= until - 1e-9:
                return True
            if self._stop_at is not None and self.time >= self._stop_at - 1e-9:
                raise self._stop
            self.step += 1
            self._rows.append(self._row(self.time))
        return self.time >= until - 1e-9

    def checkpoint(self):
        return {"state/time": np.array([self.time]), "run/step": np.array([self.step], dtype="u8")}

    def restore(self, arrays):
        self.step = int(arrays["run/step"][0])
        self._rows = []

    def finish(self):
        pass

    def progress(self):
        _, kinetic, strain, total, friction, contacts = self._row(self.time)[:6]
        return {
            "step": self.step,
            "time": self.time,
            "contacts": contacts,
            "retried": 2,
            "kinetic": kinetic,
            "strain": strain,
            "springs": 0.0,
            "friction": friction,
            "total": total,
        }

    def summary(self):
        return {
            "steps": self.step,
            "dofs": 10,
            "size": 2.0,
            "end_time": self.time,
            "time_step": self._analysis["time_step"],
            "newton_iterations": 0,
            "factorisations": 0,
            "retried_steps": 0,
            "energy": {
                **dict.fromkeys(EnergySummary.__annotations__, 0.0),
                "initial": 8.0,
                "final": 8.0,
            },
            "certificate": {
                "max_joule": self._certificate,
                "solver_joule": self._certificate,
                "max_residual": 0.0,
                "reference_joule": 1.0,
                "tolerance_joule": 1e-9,
            },
            "bodies": [],
            "pairs": [],
            "max_blend": 0.0,
            "repaid": 0.0,
            "least_friction": 0.0,
            "min_gap": float("inf"),
            "penetration": {"max_depth": 0.0, "worst": None},
            "cross_check": None,
            "contacts": [
                {
                    "pair": ["left", "right"],
                    "onset": 0.2,
                    "release": 0.3,
                    "peak_force": 1.0,
                    "friction_work": 0.1,
                },
                {
                    "pair": ["left", "floor"],
                    "onset": 0.5,
                    "release": None,
                    "peak_force": 1.0,
                    "friction_work": 0.1,
                },
            ],
        }
