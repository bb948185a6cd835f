"""Fields of a run as arrays that lie in a file."""

import h5py
import numpy as np
import pytest

from carom import InputError
from carom.io.frames import Frames
from carom.running.run import drive
from stand_in import MESH, FallingSimulation, made_up_fields

NODES, CELLS = 2 * 57, 2 * 48
"""Of two discs with 4 divisions."""


@pytest.fixture
def reads(monkeypatch):
    """The frames that have been read, call by call."""
    seen = []
    read = Frames.read

    def noted(self, name, frames, rows):
        seen.append((name, list(frames), rows.stop - rows.start))
        return read(self, name, frames, rows)

    monkeypatch.setattr(Frames, "read", noted)
    return seen


@pytest.fixture
def made_up(scenario, tmp_path):
    """Frames every 0.25 s of numbers that are known."""
    scenario = scenario.with_overrides(["output.fields_every=0.25"])
    return drive(FallingSimulation(scenario), scenario, tmp_path)


def test_nothing_is_read_before_it_is_indexed(impact, reads):
    fields = impact.fields
    stress = fields["stress"]
    assert stress.shape == (len(fields.times), CELLS, 6)
    assert fields["velocity"].shape == (len(fields.times), NODES, 2)
    assert fields["energy_density"].shape == (len(fields.times), CELLS)
    assert "Cauchy stress [Pa]" in repr(stress)
    assert "114 nodes, 96 cells" in repr(fields)
    assert reads == []
    assert stress[-1].shape == (CELLS, 6)
    assert stress[1:3, :, 0].shape == (2, CELLS)
    last = len(fields.times) - 1
    assert reads == [("stress", [last], CELLS), ("stress", [1, 2], CELLS)]


def test_indices_are_those_of_an_array(made_up):
    times = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    np.testing.assert_allclose(made_up.fields.times, times)
    velocity = made_up.fields["velocity"]
    everything = np.array([made_up_fields(time)["velocity"] for time in times])
    np.testing.assert_array_equal(np.asarray(velocity), everything)
    np.testing.assert_array_equal(list(velocity), everything)
    for key in (0, -1, slice(None, None, 2), slice(None, None, -1), [3, 1], np.array([True] * 5)):
        np.testing.assert_array_equal(velocity[key], everything[key])
    for key in ((2, 1), (slice(1, 3), 4), (..., 1), (slice(None), slice(1, 3), 0), (-1, ..., 0)):
        np.testing.assert_array_equal(velocity[key], everything[key])
    np.testing.assert_array_equal(velocity.at(0.6), everything[2])
    with pytest.raises(IndexError):
        velocity[5]
    with pytest.raises(ValueError, match="a copy"):
        velocity.__array__(copy=False)


def test_cells_with_fewer_nodes_are_filled_up(made_up):
    np.testing.assert_array_equal(made_up.fields.connectivity, [[0, 1, 2, 3], [1, 4, 2, -1]])
    np.testing.assert_array_equal(made_up.fields.cell_types, MESH["types"])
    assert made_up.fields.points.shape == (5, 2)


def test_a_body_is_a_part_that_counts_from_0(impact):
    fields = impact.fields
    left, right = fields.body("left"), fields.body("right")
    for name in fields:
        parts = np.concatenate([left[name][-1], right[name][-1]])
        np.testing.assert_array_equal(parts, fields[name][-1])
    assert np.linalg.norm(right.points - [2.05, 1.4], axis=1).max() == pytest.approx(1.0)
    assert set(right.connectivity.ravel()) == set(range(len(right.points)))
    with pytest.raises(InputError, match=r"rihgt: no such body.*right"):
        fields.body("rihgt")


def test_boundaries_have_facets_on_the_same_nodes(impact):
    surface = impact.surface
    assert surface["pressure"].on == "facet"
    right = surface.body("right")
    assert len(right.points) == NODES / 2
    assert np.linalg.norm(right.points[right.connectivity] - [2.05, 1.4], axis=2) == pytest.approx(
        1
    )
    taken = (surface["friction_energy"][-1] * surface["area"][-1]).sum()
    assert taken == pytest.approx(impact.summary["energy"]["friction"])


def test_a_field_that_is_not_there_is_named(impact):
    with pytest.raises(KeyError, match=r"stres: no such field.*stress"):
        impact.fields["stres"]
    assert "stres" not in impact.fields


def test_a_dataset_has_dimensions_units_and_reads_when_used(impact, reads):
    data = impact.fields.to_xarray()
    assert reads == []
    assert data.stress.dims == ("time", "cell", "component")
    assert data.velocity.dims == ("time", "node", "axis")
    assert data.energy_density.attrs["units"] == "J/m³"
    assert data.plastic_strain.attrs["units"] == "1"
    late = data.stress.sel(time=0.1, component="yy").values
    assert reads == [("stress", [4], CELLS)]
    np.testing.assert_array_equal(late, impact.fields["stress"][4, :, 1])
    every_third = data.velocity.isel(time=slice(0, None, 3), node=[5, 2]).values
    np.testing.assert_array_equal(every_third, impact.fields["velocity"][::3, [5, 2]])
    inside = data.displacement.where(data.node_body == "right", drop=True)
    right = impact.fields.body("right").to_xarray()
    np.testing.assert_array_equal(inside.values, right.displacement.values)
    assert set(right.cell_body.values) == {"right"}
    np.testing.assert_array_equal(right.position.values, impact.fields.body("right").points)


def test_a_dataset_of_boundaries_has_facets(impact):
    data = impact.surface.to_xarray()
    assert data.pressure.dims == ("time", "facet")
    assert (data.facet_body == "left").sum() == (data.facet_body == "right").sum() == 16


def test_a_dataset_goes_into_a_file_and_back(impact, tmp_path):
    xarray = pytest.importorskip("xarray")
    data = impact.fields.to_xarray()
    data.to_netcdf(tmp_path / "fields.nc", engine="netcdf4")
    with xarray.open_dataset(tmp_path / "fields.nc", engine="netcdf4") as back:
        np.testing.assert_array_equal(back.stress.values, data.stress.values)
        assert back.stress.attrs == data.stress.attrs


@pytest.mark.parametrize(
    ("module", "use"),
    [("xarray", lambda r: r.fields.to_xarray()), ("pandas", lambda r: r.to_pandas())],
)
def test_a_missing_package_is_named_with_the_remedy(impact, monkeypatch, module, use):
    monkeypatch.setitem(__import__("sys").modules, module, None)
    with pytest.raises(InputError, match=rf"needs {module} .*pip install 'carom\[data\]'"):
        use(impact)


def test_the_file_stays_free_for_others(impact):
    impact.fields["stress"][0]
    with h5py.File(impact.fields_path, "r+") as file:  # refused while another has it open
        assert "VTKHDF" in file
