"""A law of small strains takes a rotation for strain, and nobody may believe what comes of it."""

import math
import warnings

import numpy as np
import pytest

import carom
from carom.building.build import build
from carom.doctor import turning
from carom.doctor.patient import Patient
from carom.results.turning import turned

LAWS = {"linear-elastic": carom.LinearElastic, "saint-venant-kirchhoff": carom.SaintVenantKirchhoff}


def case(law="linear-elastic", end_time=0.1, mesh=None, **body):
    mesh = mesh or carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 1.0], divisions=[2, 2])
    return carom.Scenario(
        dimension=3 if isinstance(mesh, carom.Box) else 2,
        analysis=carom.Dynamic(end_time=end_time, time_step=1e-3),
        output=carom.Output(fields_every=0.01, checkpoint_every=0.05),
        materials={"e": LAWS[law](young=1e6, poisson=0.3, density=1e3)},
        bodies=[carom.Body(name="b", material="e", mesh=mesh, **body)],
    )


def codes(scenario, out):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", carom.CaromWarning)
        return [one for one in carom.run(scenario, out=out).warnings if "turned" in one.code]


# Symptom guarded against: a spinning block of linear-elastic swelled, and its run was "completed"
# without a word.
@pytest.mark.parametrize("space", [False, True])
def test_a_block_of_linear_elastic_that_turns_is_told_of_once(tmp_path, space):
    box = carom.Box(corner=[0.0] * 3, size=[1.0] * 3, divisions=[1, 1, 1])
    more = {"mesh": box, "spin": [0.0, 6.0, 0.0]} if space else {"spin": 6.0}
    (warning,) = codes(case(**more), tmp_path / "fast")
    assert (warning.code, warning.where) == ("linear-elastic-turned", "bodies.0.material")
    assert warning.value == pytest.approx(math.degrees(6.0 * 0.03), rel=0.02)
    assert warning.allowed == 10.0
    # Symptom guarded against: a CaromWarning had no message, which the page on results promises.
    assert warning.message == str(warning)
    assert warning.message.startswith(
        "body b has turned by 10° at t = 0.03 s, which linear-elastic"
    )
    assert str(warning).endswith("which turns with the body")
    slow = {**more, "spin": [0.0, 0.2, 0.0] if space else 0.2}
    assert codes(case(**slow), tmp_path / "slow") == []
    assert codes(case("saint-venant-kirchhoff", **more), tmp_path / "other") == []


def test_what_was_told_before_a_stop_is_told_once(tmp_path):
    def stop(state):
        if state.time > 0.05:
            raise carom.Stop("enough")

    whole, parts = tmp_path / "whole", tmp_path / "parts"
    scenario, once = case(spin=6.0), carom.Observer(stop, every=0.06)
    with pytest.warns(carom.CaromWarning, match="has turned by"):
        carom.run(scenario, out=whole)
    with pytest.warns(carom.CaromWarning, match="has turned by"):
        carom.run(scenario, out=parts, observers=[once])
    with pytest.warns(carom.CaromWarning, match="has turned by"):
        again = carom.run(scenario, out=parts, resume=True)
    assert again.summary["warnings"] == carom.Result.open(whole).summary["warnings"]


def test_the_rotation_that_fits_best_is_found():
    rng = np.random.default_rng(3)
    points = rng.normal(size=(20, 3))
    c, s = math.cos(0.3), math.sin(0.3)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    for dimension in (2, 3):
        x = points[:, :dimension]
        moved = 1.1 * x @ rotation[:dimension, :dimension].T + 5.0
        assert turned(x, moved - x) == pytest.approx(0.3, rel=1e-9)
        assert turned(x, np.zeros_like(x)) == pytest.approx(0.0, abs=1e-7)


def found(scenario):
    return list(turning(Patient(scenario, build(scenario))))


def test_the_doctor_warns_of_a_spin_and_of_what_may_turn_when_it_is_hit():
    (spins,) = found(case(spin=2.0))
    assert (spins.level, spins.key) == ("warning", "bodies.0.material")
    assert spins.what.startswith("b spins by 11.5° until the end, which linear-elastic of mat")
    assert "take saint-venant-kirchhoff" in spins.remedy
    (fast,) = found(case(velocity=[0.0, -3.0]))
    assert fast.level == "advice"
    assert fast.what.startswith("b is so fast that it may turn by 24.3° when something hits it")
    assert found(case(spin=0.2, velocity=[0.0, 0.01])) == []
    assert found(case("saint-venant-kirchhoff", spin=2.0)) == []
    held = {"motions": (carom.Fixed(body="b", on="left"),)}
    assert found(case(spin=2.0).model_copy(update=held)) == []
