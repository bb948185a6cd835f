"""θ = ξ > ½ dissipates, the more the larger, and never creates energy."""

import numpy as np
import pytest
from runs import theta_scheme

THETAS = (0.5, 0.55, 0.75, 1.0)


@pytest.fixture(params=["bars", "cylinders"])
def sweep(request, bars_run, cylinders_run):
    """Runs by θ: the bars, and the cylinders until they have met."""
    run, case = {
        "bars": (bars_run, {"elements": 50}),
        "cylinders": (cylinders_run, {"friction": 0.2, "end_time": 3.2}),
    }[request.param]
    return {theta: run(**case, overrides=(theta_scheme(theta),)) for theta in THETAS}


def test_larger_theta_dissipates_more(sweep):
    final = [run.energy("final") for run in sweep.values()]
    assert np.all(np.diff(final) < -1e-3)
    dissipated = [run.energy("scheme") for run in sweep.values()]
    assert dissipated[0] == 0.0
    assert np.all(np.diff(dissipated) > 1e-3)


def test_energy_never_rises_when_the_scheme_dissipates(sweep):
    for theta in THETAS[1:]:
        assert sweep[theta].energy_rise <= 1e-12


def test_scheme_dissipates_in_every_step(sweep):
    for theta in THETAS[1:]:
        assert np.diff(sweep[theta].curve("scheme")).min() >= -1e-15


def test_ledger_accounts_for_the_loss(sweep):
    for run in sweep.values():
        assert run.energy("max_defect") <= 1e-3
