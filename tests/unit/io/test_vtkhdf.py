"""VTK's own reader, which is also ParaView's and PyVista's, sees what was written."""

import h5py
import numpy as np
import pytest

import carom
from carom.building.build import build
from carom.io.vtkhdf import FieldsWriter
from stand_in import MESH, made_up_fields

TIMES = [0.0, 0.1, 0.25, 0.1 + 0.2]


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "fields.vtkhdf"
    writer = FieldsWriter(path, MESH)
    for times in (TIMES[:1], TIMES[1:]):
        writer.append(times, [made_up_fields(time) for time in times])
    return path


@pytest.fixture
def reader(path):
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    return reader


def grid_at(reader, step):
    reader.SetStep(step)
    reader.Update()
    return reader.GetOutputDataObject(0)


def test_vtk_sees_every_time(reader):
    assert reader.GetNumberOfSteps() == len(TIMES)
    values = reader.GetOutputInformation(0).Get(reader.GetExecutive().TIME_STEPS())
    assert list(values) == TIMES


@pytest.mark.parametrize("step", [3, 0, 2, 1])
def test_vtk_sees_every_value(reader, step):
    from vtkmodules.util.numpy_support import vtk_to_numpy

    grid = grid_at(reader, step)
    fields = made_up_fields(TIMES[step])

    points = vtk_to_numpy(grid.GetPoints().GetData())
    np.testing.assert_array_equal(points[:, :2], MESH["points"])
    np.testing.assert_array_equal(points[:, 2], 0.0)
    assert [grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())] == [9, 5]
    cells = grid.GetCells()
    np.testing.assert_array_equal(vtk_to_numpy(cells.GetConnectivityArray()), MESH["connectivity"])
    np.testing.assert_array_equal(vtk_to_numpy(cells.GetOffsetsArray()), MESH["offsets"])

    for name in ("displacement", "velocity", "reaction"):
        read = vtk_to_numpy(grid.GetPointData().GetArray(name))
        np.testing.assert_array_equal(read[:, :2], fields[name])
        np.testing.assert_array_equal(read[:, 2], 0.0)
    for name in ("stress", "strain", "energy_density", "plastic_strain"):
        read = vtk_to_numpy(grid.GetCellData().GetArray(name))
        np.testing.assert_array_equal(read, fields[name])
    np.testing.assert_array_equal(vtk_to_numpy(grid.GetCellData().GetArray("body")), MESH["body"])


def test_frames_are_on_disk_at_once_and_the_file_is_closed(tmp_path):
    path = tmp_path / "fields.vtkhdf"
    writer = FieldsWriter(path, MESH)
    for frame, time in enumerate(TIMES, start=1):
        writer.append([time], [made_up_fields(time)])
        with h5py.File(path, "r") as file:
            assert file["VTKHDF/Steps"].attrs["NSteps"] == frame
            assert file["VTKHDF/Steps/Values"][:].tolist() == TIMES[:frame]


def test_three_components_are_kept(tmp_path):
    path = tmp_path / "fields.vtkhdf"
    fields = made_up_fields(0.0) | {"velocity": np.arange(15.0).reshape(5, 3)}
    FieldsWriter(path, MESH).append([0.0], [fields])
    with h5py.File(path, "r") as file:
        np.testing.assert_array_equal(file["VTKHDF/PointData/velocity"][:], fields["velocity"])


@pytest.mark.parametrize("cell", ["wedge6", "wedge15", "hex20", "tet10"])
def test_sides_of_cells_look_outward_to_vtk(tmp_path, cell):
    """VTK's pages show the base of a wedge the other way round than its sources have it."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    box = carom.Box(corner=[0, 0, 0], size=[1, 2, 3], divisions=[1, 2, 1], cell=cell)
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(end_time=1.0, time_step=1.0),
        materials={"m": carom.LinearElastic(young=1.0, poisson=0.3, density=1.0)},
        bodies=[carom.Body(name="b", material="m", mesh=box)],
    )
    native = build(scenario)
    FieldsWriter(tmp_path / "box.vtkhdf", native.mesh()).append([0.0], [native.fields()])
    reader = vtkHDFReader()
    reader.SetFileName(str(tmp_path / "box.vtkhdf"))
    reader.Update()
    grid = reader.GetOutputDataObject(0)
    points = vtk_to_numpy(grid.GetPoints().GetData())
    assert grid.GetNumberOfCells() > 0
    for index in range(grid.GetNumberOfCells()):
        one = grid.GetCell(index)
        ids = one.GetPointIds()
        middle = points[[ids.GetId(k) for k in range(ids.GetNumberOfIds())]].mean(axis=0)
        for side in range(one.GetNumberOfFaces()):
            ids = one.GetFace(side).GetPointIds()
            a, b, c = points[[ids.GetId(k) for k in range(3)]]
            assert np.cross(b - a, c - a) @ (a - middle) > 0.0
