"""Taylor's anvil test: a copper bar that a rigid wall shortens and mushrooms.

Published axisymmetric solutions of this bar (among them Kamoulakos 1990, Zhu & Cescotto 1995,
Camacho & Ortiz 1997) end at a length of 21.4 to 21.5 mm and a foot radius of 7.0 to 7.2 mm.
The mesh here is coarse, 4 × 30 cells.
"""

import numpy as np
import pytest
from runs import EXAMPLES

import carom
from carom import Scenario

LENGTH, RADIUS = 32.4e-3, 3.2e-3


@pytest.fixture(scope="module")
def bar(tmp_path_factory):
    coarse = ["bodies.0.mesh.divisions=[4, 30]", "analysis.time_step=1e-7"]
    scenario = Scenario.from_toml(EXAMPLES / "taylor_bar.toml").with_overrides(coarse)
    return carom.run(scenario, out=tmp_path_factory.mktemp("taylor"))


def test_the_bar_ends_as_long_and_as_wide_as_published(bar):
    # Over the wall, on which the foot still stands in its middle; its rim is lifted by 0.1 mm.
    assert 21.4e-3 < LENGTH + bar.history["tail.u_y"][-1] < 21.5e-3
    assert 7.0e-3 < RADIUS + bar.history["foot.u_x"][-1] < 7.2e-3
    assert bar.history["foot.u_y"][-1] == pytest.approx(0.1e-3, abs=0.03e-3)


def test_almost_all_energy_goes_into_plastic_work_and_the_books_close(bar):
    energy = bar.summary["energy"]
    assert energy["plastic"] > 0.98 * energy["initial"]
    assert energy["max_defect"] < 1e-9 * energy["initial"]
    # Flow gives nothing back.
    assert np.diff(bar.history["plastic"]).min() >= 0.0
