"""Cases that start from bodies that are not as they are drawn."""

import json
import shutil

import numpy as np
import pytest

import carom
import staging


def first(directory, **more):
    """The first stage of the joint as a case of its own."""
    case = staging.case()
    stages = case.pop("stages")
    case |= {"analysis": stages[0]["analysis"], "loads": stages[0]["loads"], **more}
    return carom.run(carom.Scenario.from_dict(case), out=directory)


def rest_of(result, **initial):
    """The other stages of the joint, from the results of the first."""
    case = staging.case()
    case["loads"] = case["stages"].pop(0)["loads"]
    case["initial"] = {"result": str(result), "time": 1.0, **initial}
    return case


@pytest.fixture(scope="module")
def preload(tmp_path_factory):
    return first(tmp_path_factory.mktemp("preload")).path


@pytest.fixture(scope="module")
def joint(tmp_path_factory):
    return carom.run(staging.scenario(), out=tmp_path_factory.mktemp("joint"))


def test_a_result_as_the_start_is_the_same_run_in_stages(preload, joint, tmp_path):
    """To the last bit: time runs on, and so do reactions, and what is held."""
    result = carom.run(carom.Scenario.from_dict(rest_of(preload)), out=tmp_path)
    stage = joint.history["stage"]
    for column in ("time", "kinetic", "strain", "total", "lid.x", "lid.v_x", "normal_force"):
        np.testing.assert_array_equal(
            result.history[column][1:], joint.history[column][stage > 1], err_msg=column
        )
    for field in ("displacement", "velocity", "reaction", "stress"):
        np.testing.assert_array_equal(result.fields[field][-1], joint.fields[field][-1])
    for mine, other in zip(result.summary["stages"], joint.summary["stages"][1:], strict=True):
        assert mine == other
    # Its own books begin with the energy of the preload.
    energy = result.summary["energy"]
    assert energy["initial"] == joint.summary["stages"][0]["energy"]["final"]
    assert energy["friction"] == pytest.approx(
        sum(stage["energy"]["friction"] for stage in joint.summary["stages"][1:]), rel=1e-12
    )
    assert energy["max_defect"] < 1e-11
    # Slip and friction count from the start of this run.
    assert (result.surface["slip"][0] == 0.0).all()


def test_a_single_analysis_goes_on_from_a_result(preload, tmp_path):
    case = rest_of(preload)
    case |= {"analysis": {"end_time": 1.00001, "time_step": 5e-7}}
    del case["stages"]
    result = carom.run(carom.Scenario.from_dict(case), out=tmp_path)
    assert result.history["time"][0] == 1.0
    assert np.abs(result.history["kinetic"]).max() < 1e-15
    assert result.scenario.initial == carom.Initial(result=str(preload), time=1.0)


def test_a_run_from_a_result_goes_on_after_a_stop(preload, tmp_path):
    def stop(state):
        if state.time > 1.00001:
            raise carom.Stop

    scenario = carom.Scenario.from_dict(rest_of(preload))
    whole = carom.run(scenario, out=tmp_path / "whole")
    carom.run(scenario, out=tmp_path / "parts", observers=[carom.Observer(stop)])
    parts = carom.run(scenario, out=tmp_path / "parts", resume=True)
    for column, values in whole.history.items():
        np.testing.assert_array_equal(parts.history[column], values)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda case: case["bodies"][1]["mesh"].update(divisions=[8, 2]),
            "initial.result: .* is a run of others: the meshes of the bodies are others",
        ),
        (
            lambda case: case["materials"]["steel"].update(young=1e9),
            "is a run of others: materials.steel.young = 1000000000.0, there it is 210000000000.0",
        ),
        (
            lambda case: case["contact"].update(discretisation="mortar"),
            'contact.discretisation = "mortar", there it is "node-to-segment"',
        ),
        (
            lambda case: case["initial"].update(time=0.5),
            r"initial.time = 0.5: .* ended at t = 1 s; give time = 1",
        ),
        (
            lambda case: case["bodies"][1].update(velocity=[1.0, 0.0]),
            "bodies.1.velocity .*the case goes on from a result, with the velocities of that",
        ),
        (
            lambda case: case["contact"].update(resolve_overlap=True),
            "contact.resolve_overlap: overlaps were taken up by the run",
        ),
        (
            lambda case: case["initial"].pop("time"),
            "initial.time: required key is missing: when the result ended",
        ),
    ],
)
def test_a_result_that_does_not_fit_is_refused(preload, tmp_path, change, message):
    case = rest_of(preload)
    change(case)
    with pytest.raises(carom.InputError, match=message):
        carom.run(carom.Scenario.from_dict(case), out=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_results_without_an_end_are_refused(preload, tmp_path):
    def refused(directory):
        with pytest.raises(carom.InputError) as caught:
            carom.check(carom.Scenario.from_dict(rest_of(directory)))
        assert caught.value.key == "initial.result"
        return str(caught.value)

    assert "there is no such directory" in refused(tmp_path / "nowhere")
    (tmp_path / "empty").mkdir()
    assert "has no results of a run that ended" in refused(tmp_path / "empty")
    other = tmp_path / "other"
    shutil.copytree(preload, other)
    content = bytearray((other / "end_state.h5").read_bytes())
    content[-9] ^= 1
    (other / "end_state.h5").write_bytes(content)
    assert "is damaged: its checksum is another; run that case again" in refused(other)
    (other / "end_state.h5").unlink()
    assert "has no end_state.h5, which this version leaves" in refused(other)
    summary = json.loads((other / "summary.json").read_text())
    (other / "summary.json").write_text(json.dumps({**summary, "status": "stopped"}))
    assert "that run ended as stopped; name one that completed" in refused(other)


BLOCK = {
    "materials": staging.CASE["materials"],
    "bodies": [
        {
            "name": "block",
            "material": "steel",
            "mesh": {"kind": "rectangle", "corner": [0, 0], "size": [1, 1], "divisions": [2, 2]},
        }
    ],
    "analysis": {"end_time": 1e-5, "time_step": 1e-6},
}


def stretched(tmp_path, amount=1e-3, **more):
    """A block that is stretched along x when it is let go."""
    points = carom.Simulation(carom.Scenario.from_dict(BLOCK)).bodies["block"].points
    np.save(tmp_path / "u.npy", points * [amount, 0.0])
    displacements = [{"body": "block", "file": str(tmp_path / "u.npy")}]
    return {**BLOCK, "initial": {"displacements": displacements}, **more}


def test_displacements_of_a_file_are_strain_energy_at_the_start(tmp_path):
    simulation = carom.Simulation(carom.Scenario.from_dict(stretched(tmp_path)))
    # ½ E (1 − ν) / ((1 + ν)(1 − 2ν)) ε² in plane strain
    modulus = 210e9 * 0.7 / (1.3 * 0.4)
    assert simulation.energy.strain == pytest.approx(0.5 * modulus * 1e-6, rel=1e-12)
    assert simulation.history["total"][0] == simulation.energy.total
    for _ in range(10):
        simulation.step()
    assert simulation.energy.kinetic > 0.0
    assert np.abs(simulation.history["defect"]).max() < 1e-12 * simulation.energy.total


def test_velocities_that_are_set_leave_displacements_as_they_are(tmp_path):
    simulation = carom.Simulation(carom.Scenario.from_dict(stretched(tmp_path)))
    energy = simulation.energy
    simulation.set_velocity("block", [0.0, 2.0])
    assert simulation.energy.strain == energy.strain
    assert simulation.energy.kinetic == pytest.approx(0.5 * 7800.0 * 4.0)
    assert simulation.history["total"][0] == simulation.energy.total


def test_displacements_of_a_result_are_its_last(tmp_path):
    case = {
        **BLOCK,
        "analysis": {"kind": "static", "end_time": 1.0, "time_step": 1.0},
        "motions": [{"kind": "fixed", "body": "block", "on": "left"}],
        "loads": [{"kind": "traction", "body": "block", "on": "right", "traction": [1e8, 0.0]}],
    }
    pulled = carom.run(carom.Scenario.from_dict(case), out=tmp_path / "pulled")
    # Paths of a case file begin where the file is.
    file, text = tmp_path / "let-go.toml", carom.Scenario.from_dict(BLOCK).to_toml()
    displaced = '[[initial.displacements]]\nbody = "block"\nresult = "pulled"\n'
    file.write_text(f"{text}\n{displaced}")
    simulation = carom.Simulation(carom.Scenario.from_toml(file))
    np.testing.assert_array_equal(
        simulation.bodies["block"].displacement, pulled.fields["displacement"][-1]
    )
    assert simulation.energy.strain == pytest.approx(pulled.history["strain"][-1], rel=1e-12)


def test_a_spin_is_about_where_the_body_is(tmp_path):
    moved = stretched(tmp_path, 0.0)
    points = carom.Simulation(carom.Scenario.from_dict(BLOCK)).bodies["block"].points
    quarter = points @ np.array([[0.0, 1.0], [-1.0, 0.0]]) + [5.0, 0.0] - points
    np.save(tmp_path / "u.npy", quarter)
    moved["materials"] = {"steel": {**BLOCK["materials"]["steel"], "kind": "neo-hookean"}}
    moved["bodies"] = [{**BLOCK["bodies"][0], "spin": 2.0, "velocity": [0.0, 1.0]}]
    block = carom.Simulation(carom.Scenario.from_dict(moved)).bodies["block"]
    x = block.positions - block.positions.mean(axis=0)
    expected = 2.0 * np.stack([-x[:, 1], x[:, 0]], axis=1) + [0.0, 1.0]
    np.testing.assert_allclose(block.velocity, expected, atol=1e-12)


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros((4, 2)), r"has the shape \(4, 2\), the nodes of block \(9, 2\)"),
        (np.full((9, 2), np.nan), "displacements must be finite numbers, in metres"),
        (np.full((9, 2), 1e300), "the energy of the initial displacements is not finite"),
        (np.array(["a", "b"]), "not an array of NumPy"),
    ],
)
def test_displacements_that_do_not_fit_are_refused(tmp_path, array, message):
    case = stretched(tmp_path)
    np.save(tmp_path / "u.npy", array)
    with pytest.raises(carom.InputError, match=message):
        carom.check(carom.Scenario.from_dict(case))


def test_displacements_of_others_are_refused(tmp_path):
    case = stretched(tmp_path)
    (tmp_path / "u.npy").unlink()
    with pytest.raises(carom.InputError, match=r"initial.displacements.0.file: .*No such file"):
        carom.check(carom.Scenario.from_dict(case))
    other = carom.Scenario.from_dict(BLOCK).with_overrides(
        ["bodies.0.mesh.divisions=[3, 2]", "output.fields_every=1e-5"]
    )
    carom.run(other, out=tmp_path / "other")
    case["initial"] = {"displacements": [{"body": "block", "result": str(tmp_path / "other")}]}
    with pytest.raises(carom.InputError, match="has 12 nodes, here it has 9"):
        carom.check(carom.Scenario.from_dict(case))
    case["bodies"] = [{**BLOCK["bodies"][0], "name": "brick"}]
    case["initial"]["displacements"][0]["body"] = "brick"
    with pytest.raises(carom.InputError, match='brick: no such body; did you mean "block"'):
        carom.check(carom.Scenario.from_dict(case))


def test_bodies_that_displacements_put_into_one_another_are_refused(tmp_path):
    case = stretched(tmp_path, 0.2)
    case["obstacles"] = [{"name": "wall", "kind": "plane", "point": [1.1, 0], "normal": [-1, 0]}]
    with pytest.raises(carom.InputError, match=r'"block" and "wall" overlap by 1\.000e-1 m'):
        carom.check(carom.Scenario.from_dict(case))


def test_displacements_that_break_what_binds_nodes_are_refused(tmp_path):
    mesh = {**BLOCK["bodies"][0]["mesh"], "periodic": True}
    case = stretched(tmp_path)
    case["bodies"] = [{**BLOCK["bodies"][0], "mesh": mesh}]
    with pytest.raises(carom.InputError, match=r"nodes \d+ and \d+ of \"block\" move as one"):
        carom.check(carom.Scenario.from_dict(case))
    points = carom.Simulation(carom.Scenario.from_dict(BLOCK)).bodies["block"].points
    np.save(tmp_path / "u.npy", np.full_like(points, 1e-3))
    case["bodies"] = [{**BLOCK["bodies"][0], "hypothesis": "axisymmetric"}]
    with pytest.raises(carom.InputError, match="is on the axis, which it cannot leave"):
        carom.check(carom.Scenario.from_dict(case))


@pytest.mark.parametrize(
    ("initial", "message"),
    [
        ({}, "initial: says nothing; give result or displacements"),
        ({"displacements": [{"body": "block"}]}, "initial.displacements.0: give file or result"),
        (
            {"displacements": [{"body": "block", "file": "a", "result": "b"}]},
            "initial.displacements.0: give file or result, one of the two",
        ),
        (
            {"displacements": [{"body": "bloc", "file": "a"}]},
            'initial.displacements.0.body = "bloc": no such body; did you mean "block"',
        ),
        (
            {"displacements": [{"body": "block", "file": "a"}, {"body": "block", "file": "b"}]},
            "initial.displacements.1.body .*already displaced by initial.displacements.0",
        ),
        (
            {"result": "a", "time": 1.0, "displacements": [{"body": "block", "file": "b"}]},
            "initial.displacements: a result has displacements of all bodies",
        ),
        (
            {"time": 1.0, "displacements": [{"body": "block", "file": "b"}]},
            "initial.time = 1.0: displacements are those at t = 0",
        ),
    ],
)
def test_a_start_that_says_nothing_or_too_much_is_refused(initial, message):
    with pytest.raises(carom.InputError, match=message):
        carom.Scenario.from_dict({**BLOCK, "initial": initial})


def test_velocities_of_a_run_from_a_result_are_not_set(preload):
    simulation = carom.Simulation(
        carom.Scenario.from_dict(
            {key: value for key, value in rest_of(preload).items() if key != "stages"}
            | {"analysis": {"end_time": 1.1, "time_step": 1e-3}}
        )
    )
    with pytest.raises(carom.InputError, match="lid: the case goes on from a result, with the"):
        simulation.set_velocity("lid", [1.0, 0.0])


def test_a_state_of_another_time_or_size_does_not_fit(preload, tmp_path):
    from carom.io.checkpoint import read_checkpoint, write_end_state

    other = tmp_path / "other"
    shutil.copytree(preload, other)
    end = read_checkpoint(other / "end_state.h5")
    slip = end.arrays.pop("state/slip")
    write_end_state(other, end)
    with pytest.raises(carom.InputError, match=r"does not fit: state/slip: is missing; run that"):
        carom.check(carom.Scenario.from_dict(rest_of(other)))
    simulation = carom.Simulation(carom.Scenario.from_dict(rest_of(preload)))._native
    end.arrays["state/slip"] = slip
    end.arrays["state/time"][0] = 0.5
    with pytest.raises(ValueError, match=r"state/time: is 0\.5 s, where the run starts at 1 s"):
        simulation.start_from(end.arrays)


def test_a_run_from_displaced_bodies_is_confirmed_from_there_on(tmp_path):
    case = {**BLOCK, "obstacles": [], "initial": stretched(tmp_path)["initial"]}
    case["output"] = {"audit": True}
    result = carom.run(carom.Scenario.from_dict(case), out=tmp_path / "run")
    audit = carom.audit(result.path)
    assert audit.refuted == ()
    assert any("starts from" in str(left) for left in audit.unchecked)
