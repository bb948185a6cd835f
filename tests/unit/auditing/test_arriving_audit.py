"""Contacts that come to their target with the end of a step land, and are counted, in the next."""

import h5py
import numpy as np
import pytest
from refuting import refuted_after
from test_growth_audit import GROWS, METAL
from two_discs import scenario

import carom

DT = 1e-2


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A block that falls on a floor, and touches it in the fourth step."""
    out = tmp_path_factory.mktemp("block")
    block = {"kind": "rectangle", "corner": [0, 0.035], "size": [1, 0.5], "divisions": [2, 2]}
    case = {
        "analysis": {"end_time": 6 * DT, "time_step": DT},
        "materials": {
            "m": {"kind": "linear-elastic", "young": 2e4, "poisson": 0.3, "density": 10.0}
        },
        "bodies": [{"name": "block", "material": "m", "mesh": block, "velocity": [0.3, -1.0]}],
        "obstacles": [{"kind": "plane", "name": "floor", "point": [0, 0], "normal": [0, 1]}],
        "contact": {"condition": "midpoint", "friction": 0.2},
        "output": {"audit": True, "fields_every": DT, "history_every": DT},
    }
    result = carom.run(carom.Scenario.from_dict(case), out=out)
    assert [int(count) for count in result.history["contacts"][:5]] == [0, 0, 0, 0, 3]
    assert carom.audit(out).refuted == ()
    return out


def with_a_reaction(force):
    """Store a contact of the third step at a node that is still 10 mm away half way."""

    def tamper(directory):
        with h5py.File(directory / "audit.h5", "r+") as file:
            step = file["steps/000002"]
            more = {
                "contact_node": [0],
                "contact_target": [-1],
                "contact_site": [[0, 0, -1, -1, -1]],
                "contact_facet": [[-1, -1, -1]],
                "contact_gap": [0.01],
                "contact_normal": [[0.0, 1.0]],
                "contact_reaction": [[0.0, force]],
                "contact_adhesion": [0.0],
            }
            for name, values in more.items():
                del step["end"][name]
                step["end"][name] = np.array(values)
            for name in ("landing", "settling"):
                del step[name]
                step[name] = np.zeros((1, 2))

    return tamper


def test_a_reaction_that_is_round_off_need_not_be_counted(run, tmp_path):
    # What it is beside the gap is in the certificate, of which the run had none.
    assert refuted_after(run, tmp_path, with_a_reaction(1e-28)) == {"certificate"}


def test_a_reaction_beside_an_open_gap_is_found(run, tmp_path):
    refuted = refuted_after(run, tmp_path, with_a_reaction(1e-7))
    assert {"Signorini: complementarity"} <= refuted
    assert "contact count" not in refuted


def test_a_reaction_that_is_not_counted_is_found(run, tmp_path):
    refuted = refuted_after(run, tmp_path, with_a_reaction(1e-3))
    assert {"Signorini: complementarity", "contact count", "normal force"} <= refuted


def test_metal_that_grows_and_flows_as_it_lands_is_confirmed(tmp_path):
    """Its last step ends with a reaction of some 1e-28 N that the run does not count."""
    changes = {"materials.m": METAL, "analysis.time_step": 1e-3, "analysis.end_time": 0.044}
    changes["output.fields_every"] = 0.044
    carom.run(scenario("midpoint", "theta", **GROWS, **changes), out=tmp_path)
    with h5py.File(tmp_path / "audit.h5") as file:
        (reaction,) = file["steps/000000/end/contact_reaction"][:]
    assert np.abs(reaction).max() < 1e-20
    assert carom.audit(tmp_path).refuted == ()
