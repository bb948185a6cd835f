"""What other codes are given, and what is read from them, without running them."""

import json
import re

import numpy as np
import pytest
from compare import calculix_files, kratos_files
from compare.energy import Energy
from compare.problems import BARS, CYLINDERS, PROBLEMS

PRINTED = """
 displacements (vx,vy,vz) for set NPRINTED and time  0.2000000E-03

         1  2.000000E-04  5.022935E-21  0.000000E+00
         2  2.000000E-04 -7.660444E-22  0.000000E+00

 velocities (vx,vy,vz) for set NPRINTED and time  0.2000000E-03

         1  1.000000E+00  4.756757E-17  0.000000E+00
         2 -9.500000E-01  7.405653E-17  0.000000E+00

 displacements (vx,vy,vz) for set NPRINTED and time  0.4000000E-03
"""
"""What CalculiX 2.20 prints, cut short: it stopped in the middle of the second look."""


def sections(deck):
    """Return the lines under each keyword line."""
    found, lines = {}, []
    for line in deck.splitlines():
        if line.startswith("*"):
            lines = found.setdefault(line, [])
        else:
            lines.append([float(word) for word in line.split(",") if re.match(r"[-\d.]", word)])
    return found


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS)
def test_bricks_of_calculix_have_the_mass_of_the_bodies(problem):
    deck = sections(calculix_files.deck(problem))
    walls = len(calculix_files.wall_corners(problem))
    nodes = np.array(deck["*NODE,NSET=NALL"])
    assert len(nodes) == 2 * (len(problem.points) + 4 * walls)
    bricks = np.array(deck["*ELEMENT,TYPE=C3D8,ELSET=EBODIES"], dtype=int)[:, 1:] - 1
    assert len(bricks) == len(problem.cells)
    corners = nodes[bricks, 1:]
    diagonals = corners[:, [2, 3], :2] - corners[:, [0, 1], :2]
    areas = np.linalg.det(diagonals) / 2
    heights = corners[:, 4:, 2] - corners[:, :4, 2]
    np.testing.assert_allclose(heights, calculix_files.THICKNESS[problem.name])
    assert (areas > 0).all()
    assert problem.density * areas.sum() == pytest.approx(Energy(problem).mass.sum())


def test_faces_of_calculix_are_those_of_the_surfaces():
    lines = calculix_files.deck(CYLINDERS).splitlines()
    start = lines.index("*SURFACE,NAME=SLEFT,TYPE=ELEMENT") + 1
    faces = [line.split(",S") for line in lines[start : start + 40]]
    cells = CYLINDERS.cells[[int(number) - 1 for number, _ in faces]]
    edges = np.array([int(face) - 3 for _, face in faces])
    rows = np.arange(40)
    on_circle = np.stack([cells[rows, edges], cells[rows, (edges + 1) % 4]], axis=1)
    np.testing.assert_array_equal(on_circle, CYLINDERS.surfaces[0])


def test_deck_of_calculix_asks_for_the_steps_of_the_problem():
    deck = calculix_files.deck(BARS)
    assert "*DYNAMIC,DIRECT,ALPHA=-0.05\n1e-05,0.04\n" in deck
    assert "NLEFT,1,1\nNLEFT,2,0\nNRIGHT,1,-1\n" in deck


def test_what_calculix_printed_is_read_and_an_unfinished_look_left_out():
    ((time, displacements, velocities),) = calculix_files.printed(PRINTED, nodes=2)
    assert time == 2e-4
    np.testing.assert_allclose(displacements, [[2e-4, 0], [2e-4, 0]], atol=1e-15)
    np.testing.assert_allclose(velocities, [[1, 0], [-0.95, 0]], atol=1e-15)


def test_walls_of_kratos_are_strips_around_the_box_that_face_inwards():
    mesh = kratos_files.everything(CYLINDERS)
    assert mesh.bodies == 1042
    corners = mesh.points[mesh.cells]
    areas = np.linalg.det(corners[:, [2, 3]] - corners[:, [0, 1]]) / 2
    assert (areas > 0).all()
    start, end = mesh.points[mesh.surfaces["Walls"]].swapaxes(0, 1)
    along = (end - start) / np.linalg.norm(end - start, axis=1)[:, None]
    outwards = (start + end) / 2 - [5.0, 3.0]
    left = np.column_stack([-along[:, 1], along[:, 0]])
    assert ((left * outwards).sum(axis=1) > 0).all()  # the body of the wall
    assert np.linalg.norm(end - start, axis=1).sum() == pytest.approx(2 * (10 + 6))


@pytest.mark.parametrize(("friction", "law"), [(0.0, "Frictionless"), (0.2, "Frictional")])
def test_kratos_is_asked_for_the_same_problem(friction, law):
    mesh = kratos_files.everything(CYLINDERS)
    project = json.loads(json.dumps(kratos_files.parameters(CYLINDERS, mesh, friction)))
    assert project["solver_settings"]["contact_settings"]["mortar_type"] == f"ALMContact{law}"
    (contact,) = project["processes"]["contact"]
    assert contact["Parameters"]["friction_coefficients"] == {"0": friction}
    model = kratos_files.model(mesh).splitlines()
    nodes = model[model.index("Begin Nodes") + 1 : model.index("End Nodes")]
    assert len(nodes) == len(mesh.points)
    for name in (*contact["Parameters"]["contact_model_part"]["0"], "Body", "Fixed"):
        assert f"Begin SubModelPart {name}" in model


def test_bars_need_no_walls():
    mesh = kratos_files.everything(BARS)
    assert list(mesh.surfaces) == ["Left", "Right"]
    assert kratos_files.parameters(BARS, mesh, 0.0)["processes"]["fixed"] == []
