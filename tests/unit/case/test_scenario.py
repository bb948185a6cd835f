import json

import numpy as np
import pytest

import carom
from carom import Scenario


@pytest.mark.parametrize(
    "name",
    [
        "two_bars.toml",
        "two_cylinders.toml",
        "two_cylinders_frictionless.toml",
        "oblique_layer.toml",
    ],
)
def test_examples_survive_toml_and_back(examples, tmp_path, name):
    scenario = Scenario.from_toml(examples / name)
    copy = tmp_path / name
    copy.write_text(scenario.to_toml(), encoding="utf-8")
    assert Scenario.from_toml(copy) == scenario
    assert Scenario.from_toml(copy).to_toml() == scenario.to_toml()


def test_everything_that_can_be_stated_survives_toml_and_back(tmp_path):
    scenario = Scenario(
        title='Ünïcode, "quotes" and a \\ backslash',
        analysis=carom.Dynamic(
            end_time=0.1 + 0.2,
            time_step=1e-7,
            scheme=carom.Theta(theta=1, xi=0.75),
            newton=carom.Newton(tolerance=1e-9, max_iterations=7),
            max_halvings=0,
            gravity=(0, -9.81),
        ),
        output=carom.Output(
            fields_every=0.01,
            history_every=1 / 300,
            merge_contacts=0,
            track=[carom.Track(name="tip", body="a", point=(1 / 3, 0))],
        ),
        materials={
            "soft-one": carom.LinearElastic(
                young=1e16, poisson=-0.5, density=1e-300, damping=carom.Damping(stiffness=1e-5)
            ),
            "hard": carom.SaintVenantKirchhoff(young=2, poisson=0.25, density=3),
        },
        bodies=[
            carom.Body(
                name="a",
                material="soft-one",
                thickness=2,
                mass="lumped",
                mesh=carom.Rectangle(corner=(0, 0), size=(1, 2), divisions=(3, 4), cell="tri3"),
                velocity=(-0.0, 1),
                spin=-3,
            ),
            carom.Body(
                name="b", material="hard", mesh=carom.Disc(centre=(9, 9), radius=1, divisions=2)
            ),
        ],
        obstacles=[carom.Plane(name="slope", point=(-5, 0), normal=(1, 2))],
        contact=carom.Contact(
            condition="midpoint",
            friction=0.3,
            solver=carom.FrictionSolver(kind="uzawa", max_iterations=5, cross_check=True),
            sources="both",
            pairs=[
                carom.Pair(between=("a", "b"), friction=0, sources="second"),
                carom.Pair(between=("b", "slope"), enabled=False),
            ],
        ),
    )
    copy = tmp_path / "case.toml"
    copy.write_text(scenario.to_toml(), encoding="utf-8")
    assert Scenario.from_toml(copy) == scenario


def test_complete_toml_reads_back_and_hides_no_default(scenario, box, tmp_path):
    for case in (scenario, Scenario.from_dict(box)):
        copy = tmp_path / "case.toml"
        copy.write_text(case.to_toml(complete=True), encoding="utf-8")
        assert Scenario.from_toml(copy) == case
        text = copy.read_text(encoding="utf-8")
        for key in ("scheme", "condition", "targets", "certificate_tolerance", "max_halvings"):
            assert f"{key} = " in text


def test_toml_is_laid_out_as_a_person_would(box):
    text = Scenario.from_dict(box).to_toml()
    for line in (
        "[analysis]",
        "[[output.track]]",
        "[materials.elastic]",
        "[[bodies]]",
        'mesh = {kind = "disc", centre = [2.0, 4.0], radius = 1.0, divisions = 8}',
        "[[contact.pairs]]",
    ):
        assert line in text.splitlines()
    assert "thickness" not in text  # at its default


def test_json_for_the_native_core_has_every_default_as_a_number(box):
    data = json.loads(Scenario.from_dict(box).to_json())
    assert data["output"]["fields_every"] == 0.01  # not 1/200: never finer than the steps
    assert data["output"]["history_every"] == 0.01
    assert data["contact"]["solver"] == {
        "kind": "auto",
        "tolerance": 1e-12,
        "max_iterations": 10000,
        "cross_check": False,
    }
    assert data["analysis"]["gravity"] is None
    assert data["bodies"][0]["velocity"] is None
    assert data["contact"]["pairs"][0]["sources"] is None


def test_json_takes_a_200th_and_a_1000th_of_a_long_run(box):
    box["analysis"]["end_time"] = 100.0
    output = json.loads(Scenario.from_dict(box).to_json())["output"]
    assert (output["fields_every"], output["history_every"]) == (0.5, 0.1)


def test_integers_and_numpy_numbers_are_numbers(box):
    box["bodies"][0]["mesh"]["radius"] = 1
    box["bodies"][0]["spin"] = np.float64(0.5)
    body = Scenario.from_dict(box).bodies[0]
    assert body.mesh.radius == 1.0
    assert isinstance(body.mesh.radius, float)
    assert body.spin == 0.5


def test_a_scenario_cannot_be_changed(scenario):
    with pytest.raises(ValueError, match="frozen"):
        scenario.title = "Other"


def test_a_periodic_body_cannot_spin(box):
    layer = {
        "kind": "rectangle",
        "corner": [0, 0],
        "size": [1, 1],
        "divisions": [1, 1],
        "periodic": True,
    }
    box["bodies"][0]["mesh"] = layer
    assert Scenario.from_dict(box).bodies[0].mesh.periodic
    box["bodies"][0]["spin"] = 0.1
    with pytest.raises(carom.InputError, match=r"bodies\.0\.spin.*periodic"):
        Scenario.from_dict(box)


@pytest.mark.parametrize(
    ("scheme", "condition"), [(carom.Conserving(), "massless"), (carom.Theta(), "midpoint")]
)
def test_the_condition_suits_the_scheme(scheme, condition):
    """Symptom guarded against: massless contact took a third of the energy of a case with theta."""
    analysis = carom.Dynamic(end_time=1.0, time_step=0.1, scheme=scheme)
    given = {
        "materials": {"m": carom.LinearElastic(young=1.0, poisson=0.3, density=1.0)},
        "bodies": [
            carom.Body(
                name="b", material="m", mesh=carom.Disc(centre=(0.0, 0.0), radius=1.0, divisions=2)
            )
        ],
    }
    assert carom.Scenario(analysis=analysis, **given).contact.condition == condition
    of_a_stage = carom.Scenario(stages=[carom.Stage(name="s", analysis=analysis)], **given)
    assert of_a_stage.full_stages()[0].contact.condition == condition
    named = carom.Scenario(analysis=analysis, contact=carom.Contact(condition="gap"), **given)
    assert named.contact.condition == "gap"


def test_numbers_of_numpy_are_numbers():
    disc = carom.Disc(centre=np.zeros(2), radius=np.float32(0.5), divisions=np.int64(4))
    assert disc == carom.Disc(centre=[0.0, 0.0], radius=0.5, divisions=4)
    box = carom.Rectangle(corner=[np.int64(0), 0], size=np.ones(2), divisions=np.array([2, 3]))
    assert box.divisions == (2, 3)
    with pytest.raises(carom.InputError, match=r"divisions = 4\.0: must be an integer"):
        carom.Disc(centre=[0, 0], radius=1, divisions=np.float64(4))
    with pytest.raises(carom.InputError, match=r"centre\.0 = \[0\.0, 0\.0\]: must be a number"):
        carom.Disc(centre=np.zeros((2, 2)), radius=1, divisions=4)


@pytest.mark.parametrize("given", ["case.toml", {"bodies": []}, None])
def test_what_is_no_scenario_is_told_how_to_become_one(given, tmp_path):
    with pytest.raises(carom.InputError, match=r"is no Scenario; carom\.Scenario\.from_toml reads"):
        carom.run(given, out=tmp_path / "out")
    assert not (tmp_path / "out").exists()
