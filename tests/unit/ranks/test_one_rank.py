"""What ranks are asked for, by an engine of one of them: nothing is missing from its sums."""

import cases
import numpy as np
import pytest
from one_rank import OneRank

import carom
from carom.building.build import build
from carom.running.run import drive


def driven(scenario, out):
    engine = OneRank()
    result = drive(build(scenario, engine=engine), scenario, out, engine=engine)
    assert engine.summed > 50
    return result


@pytest.mark.parametrize("case", [cases.discs, cases.ball, cases.pressed, cases.squeezed])
def test_one_rank_makes_the_run_of_a_process(tmp_path, case):
    alone = carom.run(case(), out=tmp_path / "alone")
    shared = driven(case(), tmp_path / "shared")
    a, b = alone.summary, shared.summary
    assert a["status"] == b["status"] == "completed"
    scale = max(abs(a["energy"]["initial"]), abs(a["energy"]["final"]))
    for name, value in a["energy"].items():
        assert b["energy"][name] == pytest.approx(value, abs=1e-10 * scale), name
    assert [event["pair"] for event in a["contacts"]] == [event["pair"] for event in b["contacts"]]
    for name in ("displacement", "stress"):
        one, other = (r.fields[name][-1] for r in (alone, shared))
        assert np.abs(one - other).max() <= 1e-7 * np.abs(one).max(), name


def test_a_body_that_flows_is_not_shared(tmp_path):
    flows = {"kind": "j2-plasticity", "young": 2e4, "poisson": 0.3, "yield_stress": 50.0}
    scenario = cases.discs(materials={"m": {**flows, "density": 10.0, "hardening": 100.0}})
    with pytest.raises(carom.InputError, match="cannot be shared among processes: its material"):
        build(scenario, engine=OneRank())
