"""Bodies of several materials: what is refused, and what files, pages and tools say of them."""

import json

import h5py
import numpy as np
import pytest
from matplotlib.text import Text
from test_core_messages import BLOCK, MATERIAL, case

import carom
import restarting
from carom import InputError, Observer, Stop
from carom._carom import Simulation
from carom.building.build import build
from carom.building.checking import check
from carom.modes.basis import modes
from carom.report.writing import write_report

STIFF = {**MATERIAL, "young": 9e5, "density": 4e3}
RIGHT = {"material": "stiff", "corner": [0.5, 0.0], "size": [0.5, 1.0]}
TOP = {"material": "stiff", "corner": [0.0, 0.5], "size": [1.0, 0.5]}

GROUPS = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "skin"
2 2 "core"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
$EndNodes
$Elements
2
1 3 2 1 1 1 2 5 4
2 3 2 2 2 2 3 6 5
$EndElements
"""


def two(*regions, **changes):
    return case({"materials.stiff": STIFF, "bodies.0.regions": list(regions), **changes})


@pytest.mark.parametrize(
    ("region", "key", "part"),
    [
        ({"material": "glas", "on": "core"}, "bodies.0.regions.0.material", "no such material"),
        ({"material": "stiff"}, "bodies.0.regions.0", "give a set of cells `on`, or `corner` and"),
        ({**RIGHT, "on": "core"}, "bodies.0.regions.0", "give a set of cells `on`, or `corner`"),
        ({"material": "stiff", "size": [1, 1]}, "bodies.0.regions.0", "`corner` and `size` of a"),
        ({**RIGHT, "corner": [0.5]}, "bodies.0.regions.0.corner", "must have 2 components"),
        ({**RIGHT, "size": [0.5, 0.0]}, "bodies.0.regions.0.size.1", "greater than 0"),
    ],
)
def test_a_region_that_is_none_is_refused(region, key, part):
    with pytest.raises(InputError) as caught:
        two(region)
    assert str(caught.value).startswith(key)
    assert part in str(caught.value)


@pytest.mark.parametrize(
    ("regions", "key", "part"),
    [
        ([{"material": "stiff", "on": "core"}], "bodies.0.regions.0.on", "has no sets of cells"),
        ([RIGHT, TOP], "bodies.0.regions.1", "is of region 0 too; a cell has one material"),
        (
            [{**RIGHT, "corner": [7.0, 0.0]}],
            "bodies.0.regions.0.corner",
            "has its middle in this box; its nodes are between [0.0, 0.0] and [1.0, 1.0]",
        ),
        (
            [RIGHT, {**RIGHT, "corner": [0.0, 0.0]}],
            "bodies.0.material",
            'every cell of body "block" is of a region, none of its material "elastic"',
        ),
    ],
)
def test_cells_that_have_no_material_or_two_are_named(regions, key, part):
    with pytest.raises(InputError) as caught:
        build(two(*regions))
    assert str(caught.value).startswith(key)
    assert part in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "key", "part"),
    [
        (
            {"materials.stiff": {**STIFF, "kind": "linear-elastic"}},
            "bodies.0.regions",
            "are some of small, some of large displacements: the body turns or it does not",
        ),
        (
            {"materials.stiff": {**STIFF, "damping": {"mass": 1.0}}},
            "bodies.0.regions",
            "differ in damping.mass: it brakes the flight of the whole body",
        ),
        (
            {
                "bodies.0.kind": "reduced",
                "bodies.0.modes": 0,
                "materials.stiff": {**STIFF, "damping": {"stiffness": 1e-3}},
            },
            "materials.stiff.damping.stiffness",
            '0.001: body "block" is reduced and damped mode by mode, by one number',
        ),
    ],
)
def test_materials_that_do_not_go_together_are_refused(changes, key, part):
    with pytest.raises(InputError) as caught:
        build(two(RIGHT, **changes))
    assert str(caught.value).startswith(key)
    assert part in str(caught.value)


def test_the_core_takes_no_region_of_a_rigid_body_and_none_that_is_set_and_box():
    data = json.loads(two(RIGHT).to_json())
    data["bodies"][0]["regions"][0]["on"] = "core"
    with pytest.raises(InputError, match="a region is a set of cells, `on`, or a box with"):
        Simulation(json.dumps(data))
    data["bodies"][0].update(kind="rigid", density=1.0, material=None)
    with pytest.raises(InputError, match='"block" is rigid and of no material; leave its regions'):
        Simulation(json.dumps(data))


def test_groups_of_a_mesh_file_are_regions(tmp_path):
    file = tmp_path / "halves.msh"
    file.write_text(GROUPS)
    mesh = {"kind": "file", "file": str(file)}
    scenario = two({"material": "stiff", "on": "core"}, **{"bodies.0.mesh": mesh})
    (body,) = build(scenario).describe()["bodies"]
    assert body["mass"] == pytest.approx(1e3 + 4e3)
    assert [of["cells"] for of in body["materials"]] == [1, 1]
    scenario = two({"material": "stiff", "on": "kern"}, **{"bodies.0.mesh": mesh})
    with pytest.raises(InputError, match=r'"kern": .*has no such set of cells; known are \["core"'):
        build(scenario)


def test_a_reduced_body_of_two_materials_has_the_vibrations_of_the_whole_one():
    whole = modes(build(two(RIGHT)).matrices(0), 1, slow=10.0)
    changes = {"bodies.0.kind": "reduced", "bodies.0.modes": 2}
    (body,) = build(two(RIGHT, **changes)).describe()["bodies"]
    assert body["mass"] == pytest.approx(0.5e3 + 2e3)
    assert body["vibrations"]["lowest"] == pytest.approx(whole.frequencies[whole.rigid], rel=1e-9)


def test_what_would_run_is_told_material_by_material():
    description = check(two(RIGHT)).description
    (body,) = description["bodies"]
    slow, fast = (of["wave_speed"] for of in body["materials"])
    assert body["mass"] == pytest.approx(0.5e3 + 2e3)
    assert fast / slow == pytest.approx(1.5)
    assert body["wave_speed"] == slow
    assert description["suggested_time_step"] == pytest.approx(0.5 / fast)
    unlikely = two(RIGHT, **{"materials.stiff": {**STIFF, "young": 9e14}})
    waves = [warning for warning in check(unlikely).warnings if "waves run at" in warning]
    assert len(waves) == 1
    assert "materials.stiff" in waves[0]


def test_copies_of_a_body_take_its_regions_with_them():
    scenario = carom.Scenario.from_dict(
        {
            "dimension": 2,
            "analysis": {"end_time": 1.0, "time_step": 0.01},
            "materials": {"elastic": MATERIAL, "stiff": STIFF},
            "patterns": [
                {
                    "body": {
                        "name": "brick",
                        "material": "elastic",
                        "regions": [RIGHT],
                        "mesh": BLOCK,
                    },
                    "at": {"kind": "grid", "counts": [2, 1], "spacing": [3.0, 3.0]},
                }
            ],
        }
    )
    bodies = build(scenario).describe()["bodies"]
    assert [[of["cells"] for of in body["materials"]] for body in bodies] == [[2, 2], [2, 2]]


def struck(**changes):
    """A block, half of which flows, hits a floor."""
    metal = {**STIFF, "kind": "j2-plasticity", "yield_stress": 2e3}
    return two(
        {**TOP, "corner": [0.0, 0.0], "material": "metal"},
        **{
            "materials.metal": metal,
            "analysis": {
                "kind": "dynamic",
                "end_time": 0.12,
                "time_step": 1e-3,
                "gravity": [0.0, -9.81],
            },
            "obstacles.0.point": [0.0, 0.0],
            "bodies.0.velocity": [0.5, -1.0],
            "bodies.0.mesh": {**BLOCK, "divisions": [4, 4]},
            "output": {"fields_every": 0.04, "checkpoint_every": 0.02},
            **changes,
        },
    )


def test_a_run_stopped_while_one_of_two_materials_flows_goes_on_to_the_last_bit(tmp_path):
    whole = carom.run(struck(), out=tmp_path / "whole")
    energy = whole.summary["energy"]
    assert energy["plastic"] > 0.01 * energy["initial"]
    assert energy["max_defect"] < 1e-9 * energy["initial"]
    strain = np.asarray(whole.fields["plastic_strain"])[-1]
    material = np.asarray(whole.fields["material"])[-1]
    assert set(material.tolist()) == {0.0, 2.0}
    assert strain[material == 2.0].max() > 0.0
    assert strain[material == 0.0].max() == 0.0

    def stop(state):
        if state.time > 0.07:
            raise Stop

    carom.run(struck(), out=tmp_path / "parts", observers=[Observer(stop, every=0.01)])
    carom.run(struck(), out=tmp_path / "parts", resume=True)
    restarting.assert_same_results(tmp_path / "parts", tmp_path / "whole")
    with h5py.File(tmp_path / "parts" / "fields.vtkhdf") as file:
        assert file["VTKHDF/CellData/material"].shape == (16,)
        offsets = file["VTKHDF/Steps/CellDataOffsets/material"][:]
    assert offsets.tolist() == [0] * len(whole.fields.times)
    drawn = carom.picture(tmp_path / "whole", field="material")
    assert any(text.get_text() == "material" for text in drawn.findobj(Text))
    page = write_report(tmp_path / "whole").read_text()
    assert '"material"' in page
    assert carom.audit(tmp_path / "whole").refuted == ()


def test_bodies_of_one_material_each_say_nothing_of_it(tmp_path):
    whole = carom.run(struck(**{"bodies.0.regions": []}), out=tmp_path / "run")
    assert "material" not in whole.fields
