"""`carom picture` draws what a run left, without a display, for papers."""

import re

import matplotlib
import matplotlib.image
import numpy as np
import pytest
from matplotlib.lines import Line2D
from typer.testing import CliRunner

import carom
from carom.cli import app
from carom.display.colours import FORCE
from falling import block


def picture(*arguments):
    return CliRunner().invoke(app, ["picture", *map(str, arguments)])


def pixels(file):
    return matplotlib.image.imread(file)[:, :, :3]


def of_colour(image, colour):
    """Return how many pixels have a colour."""
    wanted = np.array(matplotlib.colors.to_rgb(colour))
    return int((np.abs(image - wanted).max(axis=2) < 0.02).sum())


def test_a_picture_of_the_plane_has_its_width_in_millimetres(disc, tmp_path):
    answer = picture(disc, "--out", tmp_path / "a.png", "--time", 0.2)
    assert answer.exit_code == 0, answer.output
    assert answer.output.strip() == str(tmp_path / "a.png")
    assert pixels(tmp_path / "a.png").shape[1] == pytest.approx(85 / 25.4 * 300, abs=1)
    figure = carom.picture(disc, times=[0.0, 0.2])
    assert 25.4 * figure.get_figwidth() == pytest.approx(170.0)


@pytest.mark.parametrize("options", [(), ("--smooth",), ("--field", "velocity")])
def test_a_pdf_has_its_fonts_and_is_the_same_each_time(disc, tmp_path, options):
    for name in ("a.pdf", "b.pdf"):
        assert picture(disc, "--out", tmp_path / name, *options).exit_code == 0
    written = (tmp_path / "a.pdf").read_bytes()
    assert written == (tmp_path / "b.pdf").read_bytes()
    assert b"/FontFile2" in written
    assert b"/Type3" not in written


def test_an_svg_holds_the_cells_as_areas(disc, tmp_path):
    assert picture(disc, "--out", tmp_path / "a.svg").exit_code == 0
    text = (tmp_path / "a.svg").read_text()
    cells = carom.Result.open(disc).fields.cell_types
    assert text.count("<path") > len(cells)
    assert "<image" not in text or text.count("<image") == 1  # the colour bar alone
    assert "<date>" not in text
    assert "font-family" not in text


def test_cells_have_the_colours_of_their_values(disc):
    """A disc without stress has the area of a disc, in the colour of zero."""
    figure = carom.picture(disc, times=0.0, field="von-mises", limits=(-1.0, 1.0), edges=False)
    figure.canvas.draw()
    image = np.asarray(figure.canvas.buffer_rgba())[..., :3] / 255.0
    middle = matplotlib.colormaps["YlGnBu"](0.5)
    seen = of_colour(image, middle)
    # A disc of radius 1 in a window of 2.24 across, on 85 mm less the pads.
    across = (85 / 25.4 - 0.08) * figure.dpi / (2 + 2 * 0.06 * 2)
    assert seen == pytest.approx(np.pi * across**2, rel=0.1)  # 32 corners, and a rim


def test_several_instants_share_scale_and_colours(disc):
    figure = carom.picture(disc, times=[0.0, 0.1, 0.4])
    scenes = [axes for axes in figure.axes if not axes.get_title(loc="left")]
    assert len(scenes) == 3
    assert len({axes.get_xlim() for axes in scenes}) == 1
    captions = [text.get_text() for text in figure.texts]
    assert captions[:3] == ["t = 0 s", "t = 0.1 s", "t = 0.4 s"]


def test_the_nearest_frame_says_its_own_time(disc):
    figure = carom.picture(disc, times=0.17)
    assert figure.texts[0].get_text() == "t = 0.2 s"


def test_reactions_are_arrows_with_a_scale(disc, tmp_path):
    for k, options in enumerate([(), ("--reactions",)]):
        picture(disc, "--out", tmp_path / f"{k}.png", "--time", 0.1, *options)
    without, drawn = (of_colour(pixels(tmp_path / f"{k}.png"), FORCE) for k in (0, 1))
    assert without == 0
    assert drawn > 300
    figure = carom.picture(disc, times=0.1, reactions=True)
    said = [text.get_text() for text in figure.texts]
    assert any(re.fullmatch(r"[125]0* [kmµ]?N", text) for text in said), said


def test_the_length_beside_is_as_long_as_it_says(disc):
    figure = carom.picture(disc, times=0.0)
    (axes, *_) = figure.axes
    metre = np.diff(axes.transData.transform([[0, 0], [1, 0]])[:, 0])[0] / figure.dpi
    line = next(each for each in figure.findobj(Line2D) if each.axes is None)
    ends = line.get_xdata()
    (said,) = [t.get_text() for t in figure.texts if re.fullmatch(r"[\d.]+ m", t.get_text())]
    assert ends[1] - ends[0] == pytest.approx(float(said.split()[0]) * metre, rel=1e-9)


def test_values_are_in_a_unit_in_which_they_are_short(disc):
    figure = carom.picture(disc, times=0.2, limits=(0.0, 3e6))
    (bar,) = [axes for axes in figure.axes if axes.get_title(loc="left")]
    assert bar.get_title(loc="left") == "von Mises stress [MPa]"
    assert [label.get_text() for label in bar.get_xticklabels()] == ["0", "1", "2", "3"]


def test_a_window_is_what_is_seen(disc):
    axes = carom.picture(disc, window=(-1.0, -0.5, 3.0, 1.5)).axes[0]
    assert (axes.get_xlim(), axes.get_ylim()) == ((-1.0, 3.0), (-0.5, 1.5))


def test_bodies_are_told_apart(disc):
    figure = carom.picture(disc, field="body")
    assert len(figure.axes) == 1  # no colours to explain


def test_what_happened_on_boundaries_is_drawn_there(disc, tmp_path):
    answer = picture(disc, "--field", "slip", "--out", tmp_path / "a.png", "--colours", "Reds")
    assert answer.exit_code == 0, answer.output
    darkest = matplotlib.colormaps["Reds"](1.0)
    image = pixels(tmp_path / "a.png")
    scene = image[: round(0.8 * len(image))]
    assert of_colour(scene, darkest) > 20


def test_a_polygon_is_drawn_where_it_has_moved(tmp_path):
    case = block(2)
    beside = {
        "name": "beside",
        "kind": "polygon",
        "points": [[0.11, 0.02], [0.2, 0.02], [0.17, 0.2]],
    }
    pictures = []
    for k, more in enumerate(([], [beside], [{**beside, "velocity": [0.0, 8.0]}])):
        made = {**case, "obstacles": [*case["obstacles"], *more]}
        carom.run(carom.Scenario.from_dict(made), out=tmp_path / f"run{k}")
        file = tmp_path / f"{k}.png"
        window = ("--window", -0.2, -0.1, 0.3, 0.4)
        assert picture(tmp_path / f"run{k}", "--out", file, *window).exit_code == 0
        pictures.append(pixels(file))
    without, still, moved = pictures
    assert np.abs(still - without).max() > 0.1
    assert np.abs(still - moved).max() > 0.1


def test_a_hole_is_cut_into_what_is_solid(tmp_path):
    case = block(2)
    bore = {"name": "bore", "kind": "sphere", "centre": [0, 0.2], "radius": 0.5, "cavity": True}
    made = {**case, "obstacles": [bore]}
    carom.run(carom.Scenario.from_dict(made), out=tmp_path / "run")
    figure = carom.picture(tmp_path / "run", window=(-0.6, -0.4, 0.6, 0.8), field="body")
    figure.canvas.draw()
    image = np.asarray(figure.canvas.buffer_rgba())[..., :3] / 255.0
    axes = figure.axes[0]
    height = len(image)

    def at(x, y):
        column, row = axes.transData.transform([x, y])
        return image[height - 1 - int(row), int(column)]

    np.testing.assert_allclose(at(0.0, 0.6), 1.0)  # free
    assert at(0.55, 0.75).max() < 0.95  # solid


def test_what_is_no_number_is_named_and_numbers_of_numpy_are_numbers(disc):
    for options, message in (
        ({"times": "0.1"}, "time '0.1': must be a number of seconds"),
        ({"times": ["start"]}, "time 'start': must be a number of seconds"),
        ({"window": (0, 0, 1)}, "--window (0, 0, 1): give numbers, LEFT BOTTOM RIGHT TOP"),
        ({"window": "abcd"}, "--window 'abcd': give numbers, LEFT BOTTOM RIGHT TOP"),
        ({"limits": (1,)}, "--range (1,): give numbers, LOW HIGH"),
        ({"camera": 3}, "--camera 3: give numbers, AZIMUTH ELEVATION"),
        ({"width": "8"}, "--width 8: must be 15 to 2000 millimetres"),
        ({"magnification": "8"}, "--magnification 8: must be a number"),
    ):
        with pytest.raises(carom.InputError) as caught:
            carom.picture(disc, **options)
        assert str(caught.value).startswith(message)
    assert carom.picture(disc, times=np.float32(0.1))
    assert carom.picture(disc, times=np.array([0.0, 0.1]))


@pytest.mark.parametrize("file", ["case.toml", "history.csv", "fields.vtkhdf"])
def test_files_of_a_run_are_not_replaced_even_by_force(disc, file):
    before = (disc / file).read_bytes()
    answer = CliRunner().invoke(app, ["report", str(disc), "--out", str(disc / file), "--force"])
    assert answer.exit_code == 2
    assert f"{disc / file}: is of the results of a run; name another file" in answer.output
    assert (disc / file).read_bytes() == before


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--field", "velocty"), '--field velocty: no such field; did you mean "velocity"? (known'),
        (("--range", 3, 3), "--range 3 3: give two numbers, the second larger than the first"),
        (("--window", 1, 1, 0, 0), "--window 1 1 0 0: give LEFT BOTTOM RIGHT TOP in metres"),
        (("--window", 0, 0, 0, 0), "--window 0 0 0 0: give LEFT BOTTOM RIGHT TOP in metres"),
        (("--window", 0, 0, "nan", 1), "--window 0 0 nan 1: give LEFT BOTTOM RIGHT TOP"),
        (("--window", 0, 0, 1e-300, 1), "neither can be more than 1000 times the other"),
        (("--window", 0, 0, 1e308, 1e308), "nor more than 1e+12 m"),
        (("--camera", "nan", 0), "--camera nan 0: give two angles in degrees"),
        (("--magnification", "inf"), "--magnification inf: must be a number of 1e+15 at most"),
        (("--magnification", "nan"), "--magnification nan: must be a number of 1e+15 at most"),
        (("--time", "nan"), "time nan s: no frame is near; those of the run are from 0 to"),
        (("--time", 100), "time 100.0 s: no frame is near; those of the run are from 0 to"),
        (("--time", -1), "time -1.0 s: no frame is near"),
        (("--time", ",".join(["0"] * 30)), "30 instants side by side take a --width of 240 mm"),
        (("--width", -5), "--width -5.0: must be 15 to 2000 millimetres"),
        (("--width", 0), "--width 0.0: must be 15 to 2000 millimetres"),
        (("--width", 1e9), "--width 1000000000.0: must be 15 to 2000 millimetres"),
        (("--what", "energy", "--width", 0), "--width 0.0: must be 15 to 2000 millimetres"),
        (("--colours", "virdis"), "--colours virdis: no colour map of matplotlib"),
        (("--time", "0,x"), "--time 0,x: give a number, or several with commas between them"),
    ],
)
def test_bad_input_is_named(disc, tmp_path, options, message):
    answer = picture(disc, "--out", tmp_path / "a.png", *options)
    assert answer.exit_code == 2
    assert message in answer.output
    assert not (tmp_path / "a.png").exists()


def test_a_file_of_another_kind_is_refused(disc, tmp_path):
    answer = picture(disc, "--out", tmp_path / "a.bmp")
    assert answer.exit_code == 2
    assert "a.bmp: must end in .pdf, .svg or .png" in answer.output


def test_a_picture_that_is_there_is_replaced_with_force_only(disc, tmp_path):
    file = tmp_path / "a.png"
    file.write_text("mine")
    answer = picture(disc, "--out", file)
    assert answer.exit_code == 2
    assert answer.output == f"error: {file}: is there already; give --force to replace it\n"
    assert file.read_text() == "mine"
    assert picture(disc, "--out", file, "--force").exit_code == 0
    assert file.read_bytes().startswith(b"\x89PNG")


def test_a_directory_without_results_is_refused(tmp_path):
    answer = picture(tmp_path, "--out", tmp_path / "x.png")
    assert answer.exit_code == 2
    assert "fields.vtkhdf: no such file" in answer.output


def test_no_instant_is_no_picture(disc):
    with pytest.raises(carom.InputError, match="name an instant"):
        carom.picture(disc, times=[])
