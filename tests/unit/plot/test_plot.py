import itertools

import numpy as np
import PIL.Image
import pytest

from carom.plot import draw
from carom.plot.energy import energy_figure
from carom.plot.track import track_figure
from carom.running.run import drive
from stand_in import FallingSimulation


@pytest.fixture
def result(scenario, tmp_path):
    return drive(FallingSimulation(scenario), scenario, tmp_path)


def test_pictures_are_files_with_something_on_them(result):
    pictures = draw(result)
    assert [picture.name for picture in pictures] == ["energy.png", "track-tip.png"]
    for picture in pictures:
        with PIL.Image.open(picture) as pixels:
            assert min(pixels.size) > 500
            assert len(pixels.getcolors(pixels.width * pixels.height)) > 50


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


@pytest.fixture
def lasting(scenario, tmp_path):
    """Return a function that gives results of a run of some length [s]."""

    def run_(end):
        short = scenario.with_overrides(
            [f"analysis.end_time={end}", f"analysis.time_step={end / 40}"]
        )
        return drive(FallingSimulation(short), short, tmp_path / "short")

    return run_


@pytest.mark.parametrize(
    ("end", "unit", "last"),
    [
        (6e-5, "µs", 60.0),
        (2.5e-7, "µs", 0.25),
        (0.0125, "ms", 12.5),
        (0.4, "s", 0.4),
        (15, "s", 15),
    ],
)
def test_ticks_of_short_runs_do_not_overlap(lasting, end, unit, last):
    """Symptom guarded against: 0.00000, 0.00001, 0.00002, … written over one another."""
    result = lasting(end)
    for picture in (energy_figure(result), track_figure(result, track="tip")):
        axes = picture.axes[-1]
        assert axes.get_xlabel() == f"time $t$ [{unit}]"
        assert axes.lines[0].get_xdata()[-1] == pytest.approx(last)
        picture.draw_without_rendering()
        boxes = [
            label.get_window_extent()
            for label in axes.get_xticklabels()
            if axes.get_xlim()[0] <= label.get_position()[0] <= axes.get_xlim()[1]
        ]
        assert len(boxes) > 3
        assert all(left.x1 + 3 < right.x0 for left, right in itertools.pairwise(boxes))


def test_shades_of_contacts_are_in_the_unit_of_the_axis(lasting):
    (axes,) = energy_figure(lasting(0.0125)).axes
    (start, _), (end, _) = axes.patches[0].get_corners()[[0, 2]]
    assert (start, end) == pytest.approx((200.0, 300.0))
