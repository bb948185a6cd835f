import matplotlib.image
import numpy as np
import pytest

from carom.plot import draw
from carom.plot.energy import energy_figure
from carom.plot.track import track_figure
from carom.running import drive
from stand_in import FallingSimulation


@pytest.fixture
def result(scenario, tmp_path):
    return drive(FallingSimulation(scenario), scenario, tmp_path)


def test_pictures_are_files_with_something_on_them(result):
    pictures = draw(result)
    assert [picture.name for picture in pictures] == ["energy.png", "track-tip.png"]
    for picture in pictures:
        pixels = matplotlib.image.imread(picture)
        assert min(pixels.shape[:2]) > 500
        assert len(np.unique(pixels.reshape(-1, pixels.shape[2]), axis=0)) > 50


def test_energy_figure_shows_the_ledger_with_units(result):
    figure = energy_figure(result)
    (axes,) = figure.axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("time $t$ [s]", "energy [J]")
    drawn = {line.get_label(): line.get_ydata() for line in axes.lines}
    assert len(drawn) == 4
    np.testing.assert_array_equal(drawn["$E_c$ kinetic"], result.history["kinetic"])
    np.testing.assert_array_equal(drawn[r"$D_\mathrm{friction}$"], result.history["friction"])


def test_energy_figure_shades_contacts_and_those_that_last(result):
    (axes,) = energy_figure(result).axes
    spans = {patch.get_label(): patch.get_extents() for patch in axes.patches}
    assert set(spans) == {"body on body", "body on obstacle"}
    to_time = axes.transData.inverted().transform
    body, obstacle = spans["body on body"], spans["body on obstacle"]
    assert to_time((body.x0, 0))[0] == pytest.approx(0.2)
    assert to_time((body.x1, 0))[0] == pytest.approx(0.3)
    assert to_time((obstacle.x1, 0))[0] == pytest.approx(1.0)


def test_track_figure_makes_the_mean_velocity_the_one_to_read(result):
    displacement, velocity = track_figure(result, track="tip").axes
    assert displacement.get_ylabel() == "displacement [m]"
    assert velocity.get_ylabel() == "velocity [m/s]"
    widths = {line.get_label(): line.get_linewidth() for line in velocity.lines}
    assert widths[r"$v_{\mathrm{mid},x}$"] > 2 * widths["$v_x$, end of step"]


def test_a_title_is_text_and_no_mathematics(scenario, tmp_path):
    titled = scenario.with_overrides(['title="costs $\\\\foo$"'])
    assert len(draw(drive(FallingSimulation(titled), titled, tmp_path))) == 2
