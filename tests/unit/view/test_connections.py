"""Springs and point masses are drawn where they are: the core's own lengths tell."""

import matplotlib
import numpy as np
import pytest
from PIL import Image

import carom
from carom.errors import InputError
from carom.io import layout
from carom.io.frames import Frames
from carom.io.history import read_history
from carom.view.coils import LEAD, MOST_COILED, coil, dashpot, laid, shapes, straight
from carom.view.connections import Connections, connections
from carom.view.named_nodes import named_nodes
from hanging import PLANE, RUBBER, SPACE

SOLID = {"cylinder": {"divisions": 2, "layers": 2}, "tube": {"divisions": [6, 1, 2]}}
ROUND = {"base": [0.1, 0.2, 0.3], "axis": [1.0, 2.0, -1.0], "height": 0.4}
MESHES = {
    "disc": {"centre": [0.3, 0.4], "radius": 0.2, "divisions": 2},
    "ring": {"centre": [0.3, 0.4], "inner_radius": 0.1, "outer_radius": 0.3, "divisions": [8, 2]},
    "rectangle": {"corner": [1e3, 0.0], "size": [0.4, 0.1], "divisions": [4, 2]},
    "box": {"corner": [0.0, 0.0, -2.0], "size": [0.4, 0.1, 0.2], "divisions": [2, 1, 2]},
    "ball": {"centre": [0.3, 0.4, 0.1], "radius": 0.2, "divisions": 2},
    "cylinder": {**ROUND, **SOLID["cylinder"], "radius": 0.1},
    "tube": {**ROUND, **SOLID["tube"], "inner_radius": 0.1, "outer_radius": 0.2},
}
QUADRATIC = {"disc": "quad8", "ring": "tri6", "rectangle": "quad9", "box": "hex20"} | dict.fromkeys(
    ("ball", "cylinder", "tube"), "tet10"
)


def hung(mesh, sets, **more):
    """A body that hangs on a spring on each of some sets."""
    dimension = 2 if mesh["kind"] in ("disc", "ring", "rectangle") else 3
    away = {"point": [50.0, 100.0, 150.0][:dimension]}
    springs = [
        {"name": name, "between": [{"body": "body", "on": name}, away], "stiffness": 10.0}
        for name in sets
    ]
    body = {"name": "body", "material": "rubber", "mesh": mesh, **more}
    return {
        "dimension": dimension,
        "analysis": {"end_time": 2e-4, "time_step": 1e-4},
        "materials": RUBBER,
        "bodies": [body],
        "springs": springs,
        "output": {"fields_every": 1e-4, "history_every": 1e-4},
    }


def attached(case, directory):
    result = carom.run(carom.Scenario.from_dict(case), out=directory)
    return connections(result.scenario, Frames(directory / layout.FIELDS)), result


def agree_with_the_history(found, directory):
    """The ends are as far apart as the core says, in every frame, to round-off."""
    history = read_history(directory / layout.HISTORY)
    assert not found.missing
    for frame, time in enumerate(found.frames.times):
        (row,) = np.flatnonzero(history["time"] == time)
        ends = found.ends(found.drawn + found.moved(frame))
        size = max(1.0, float(np.abs(ends).max()))
        for link, (start, end) in zip(found.links, ends, strict=True):
            told = history[f"{link.name}.length"][row]
            assert np.linalg.norm(end - start) == pytest.approx(told, abs=1e-14 * size)


@pytest.fixture(scope="module")
def plane(tmp_path_factory):
    return attached(PLANE, tmp_path_factory.mktemp("plane") / "run")


@pytest.fixture(scope="module")
def space(tmp_path_factory):
    return attached(SPACE, tmp_path_factory.mktemp("space") / "run")


@pytest.mark.parametrize("which", ["plane", "space"])
def test_ends_are_where_the_core_has_them(which, request):
    found, result = request.getfixturevalue(which)
    assert len(found.links) == len(result.scenario.springs)
    agree_with_the_history(found, result.path)


@pytest.mark.parametrize("kind", MESHES)
@pytest.mark.parametrize("quadratic", [False, True], ids=["linear", "quadratic"])
def test_every_set_of_a_generated_mesh_is_found_again(kind, quadratic, tmp_path):
    mesh = {"kind": kind, **MESHES[kind]}
    if quadratic:
        mesh["cell"] = QUADRATIC[kind]
    sets = carom.Scenario.from_dict(hung(mesh, ["all"])).bodies[0].mesh.facet_sets
    found, _ = attached(hung(mesh, sets), tmp_path / "run")
    assert len(found.links) == len(sets)
    agree_with_the_history(found, tmp_path / "run")


DECK = """*NODE
1, 0., 0.
2, 1., 0.
3, 1., 1.
4, 0., 1.
5, 2., 0.
6, 2., 1.
*ELEMENT, TYPE=CPS4, ELSET=first
1, 1, 2, 3, 4
*ELEMENT, TYPE=CPS4, ELSET=second
2, 2, 5, 6, 3
*NSET, NSET=corner
5, 1
*SURFACE, NAME=roof
first, S3
second, S3
"""


def test_sets_of_a_file_are_read_from_it_again(tmp_path):
    (tmp_path / "part.inp").write_text(DECK)
    mesh = {"kind": "file", "file": str(tmp_path / "part.inp"), "move": [0.5, 0.0]}
    case = {**hung(mesh, ["first", "corner", "roof"]), "dimension": 2}
    for spring in case["springs"]:
        spring["between"][1]["point"] = [5.0, 5.0]
    found, result = attached(case, tmp_path / "run")
    agree_with_the_history(found, result.path)
    (tmp_path / "part.inp").unlink()
    gone = connections(result.scenario, found.frames)
    assert len(gone.missing) == 3
    assert "The spring first is not drawn" in gone.missing[0]
    assert "part.inp" in gone.missing[0]


def test_a_file_that_is_another_one_by_now_is_not_believed(tmp_path):
    (tmp_path / "part.inp").write_text(DECK)
    mesh = carom.MeshFile(file=str(tmp_path / "part.inp"))
    with pytest.raises(InputError, match="another mesh than the one that was run"):
        named_nodes(mesh, "roof", np.zeros((7, 2)))
    points = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [2, 0], [2, 1]], dtype=float)
    assert named_nodes(mesh, "roof", points).tolist() == [2, 3, 5]
    with pytest.raises(InputError, match="another mesh than the one that was run"):
        named_nodes(mesh, "roof", points + np.array([0.0, 0.1]))
    with pytest.raises(InputError, match="has no set 'cellar'"):
        named_nodes(mesh, "cellar", points)
    with pytest.raises(InputError, match="no node is on this set"):
        named_nodes(carom.Disc(centre=[0, 0], radius=1, divisions=2), "left", np.zeros((6, 2)))


def test_forces_are_those_of_the_history(plane):
    found, result = plane
    history = read_history(result.path / layout.HISTORY)
    forces = found.forces(history, [0, 5])
    assert forces[1, 0] == np.interp(found.frames.times[5], history["time"], history["cable.force"])
    assert np.isnan(found.forces({"time": history["time"]}, [0])).all()


@pytest.mark.parametrize("dimension", [2, 3])
def test_coils_go_from_end_to_end_and_keep_their_width(dimension):
    start, end = np.arange(1.0, dimension + 1), np.array([4.0, -2.0, 7.0])[:dimension]
    for shape in (coil(5, dimension), dashpot(dimension), straight()):
        lines = laid([shape], np.array([[start, end]]), width=0.1)
        along = (end - start) / np.linalg.norm(end - start)
        away = lines - start
        across = away - np.multiply.outer(away @ along, along)
        assert np.linalg.norm(across, axis=2).max() <= 0.1 * (1 + 1e-12)
        points = lines.reshape(-1, dimension)
        for place in (start, end):
            assert np.abs(points - place).sum(axis=1).min() < 1e-12
    zigzag = laid([coil(5, dimension)], np.array([[start, end]]), width=0.1)
    assert np.allclose(zigzag[1:, 0], zigzag[:-1, 1])  # one wire
    assert np.linalg.norm(zigzag[0, 1] - start) == pytest.approx(LEAD * np.linalg.norm(end - start))


def test_a_spring_of_no_length_is_drawn_as_a_point():
    place = np.zeros((1, 2, 3))
    assert not laid([coil(4, 3)], place, width=0.1).any()


def test_many_springs_are_straight_lines(plane):
    found, _ = plane
    many = Connections(found.frames, 2, links=found.links[:1] * (MOST_COILED + 1))
    assert {len(shape) for shape in shapes(many, 1.0)} == {1}
    assert len(shapes(found, 1.0)[0]) > 8


def dark(figure, low, high):
    """Return the share of rows with ink in a part of a picture; corners in figure fractions."""
    figure.canvas.draw()
    image = np.asarray(figure.canvas.buffer_rgba())[::-1, :, :3]
    height, width = image.shape[:2]
    part = image[int(low[1] * height) : int(high[1] * height)]
    part = part[:, int(low[0] * width) : int(high[0] * width)]
    ink = np.array(matplotlib.colors.to_rgb("#1B2230")) * 255
    return float((np.abs(part - ink).max(axis=2) < 110).any(axis=1).mean())


def test_a_picture_of_the_plane_shows_springs_and_masses(plane):
    _, result = plane
    window = (0.4, 0.7, 0.6, 0.95)  # nothing is there but the hook
    seen = carom.picture(result, times=0.0, window=window, bare=True)
    assert dark(seen, (0.0, 0.02), (1.0, 0.98)) > 0.95
    empty = carom.picture(result, times=0.0, window=(0.2, 0.5, 0.3, 0.6), bare=True)
    assert dark(empty, (0.0, 0.0), (1.0, 1.0)) == 0.0
    mass = carom.picture(result, times=0.0, window=(0.39, 0.49, 0.41, 0.51), bare=True, edges=False)
    assert dark(mass, (0.49, 0.49), (0.51, 0.51)) == 1.0


def test_the_window_has_room_for_what_springs_hang_on(plane):
    _, result = plane
    figure = carom.picture(result, times=0.0)
    low, high = figure.axes[0].get_ylim()
    assert low < 0.0
    assert high > 1.0  # where the hook is fixed; the wheel ends at 0.65


def test_a_picture_of_space_shows_springs(space):
    pytest.importorskip("pyvista")
    _, result = space
    shown = carom.picture(result, times=0.0, bare=True)
    # The hook hangs above the drum, in the left half; nothing else is in the upper quarter.
    assert dark(shown, (0.0, 0.75), (1.0, 0.93)) > 0.5


def test_a_film_moves_springs_with_the_bodies(plane, tmp_path):
    _, result = plane
    # Where the hook is fixed nothing else is: what moves there is the hook.
    look = {"window": (0.4, 0.8, 0.7, 1.0), "size": (320, 240), "energies": False, "field": "body"}
    film = carom.film(result, tmp_path / "a.gif", **look)
    with Image.open(film) as pictures:
        shown = []
        for frame in (0, pictures.n_frames - 1):
            pictures.seek(frame)
            shown.append(np.asarray(pictures.convert("L"))[70:])
    assert (shown[0] < 110).any()
    assert ((shown[0] < 110) != (shown[1] < 110)).sum() > 5
