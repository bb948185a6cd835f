"""Input files of Abaqus and CalculiX that hold more, or less, than solids."""

import numpy as np
import pytest

from carom.errors import MeshError
from carom.mesh_file import body_dimension, read_body_mesh

HEAD = """*NODE, NSET=all
1, 0., 0., 0.
2, 1., 0., 0.
3, 0., 1., 0.
4, 0., 0., 1.
9, 5., 5., 5.
*ELEMENT, TYPE=C3D4, ELSET=part
1, 1, 2, 3, 4
"""


def read(tmp_path, text, *, body=None):
    (tmp_path / "deck.inp").write_text(text)
    return read_body_mesh(tmp_path / "deck.inp", body=body, scale=1.0, space=3, key="bodies.0.mesh")


def refusal(tmp_path, text):
    with pytest.raises(MeshError) as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_range_skips_numbers_that_nothing_has(tmp_path):
    """Symptom guarded against: "node 5 is not there", for a set that a pre-processor wrote."""
    arrays = read(
        tmp_path,
        f"{HEAD}*NSET, NSET=some, GENERATE\n2, 8\n3, 1000, 2\n*ELSET, ELSET=cells, GENERATE\n1, 9\n"
        "*NSET, NSET=of\nsome\n",
    )
    assert arrays.node_sets["some"].tolist() == [1, 2, 3]
    assert arrays.node_sets["of"].tolist() == [1, 2, 3]
    assert arrays.cell_sets["cells"].tolist() == [0]


def test_a_set_that_names_a_node_by_itself_needs_it(tmp_path):
    for more in ("*NSET, NSET=some\n2, 8\n", "*NSET, NSET=some, GENERATE\n2, 8\n8, 8\n"):
        text = HEAD + more + ("*NSET, NSET=some\n8\n" if "GENERATE" in more else "")
        assert "node 8 is not there" in refusal(tmp_path, text)


LOOSE = {
    "SPRINGA": "7, 1, 9",
    "SPRING2": "7, 1, 9",
    "DASHPOTA": "7, 1, 9",
    "GAPUNI": "7, 1, 9",
    "MASS": "7, 9",
    "B31": "7, 1, 9",
    "B32R": "7, 1, 2,\n9",
    "D": "7, , 9, 2",
    "U1": "7, 1, 9",
    "CONN3D2": "7, 1, 9",
}


@pytest.mark.parametrize("kind", LOOSE)
def test_elements_that_fill_no_space_are_left_out_with_a_note(tmp_path, kind):
    """Symptom guarded against: solids were refused, because there was a spring beside them."""
    text = (
        f"{HEAD}*ELEMENT, TYPE={kind}, ELSET=loose\n{LOOSE[kind]}\n"
        "*ELSET, ELSET=both\npart, loose\n*ELSET, ELSET=ends\n1, 7\n*SURFACE, NAME=skin\nboth, S1\n"
    )
    arrays = read(tmp_path, text)
    assert [(name, cells.tolist()) for name, cells in arrays.blocks] == [("tet4", [[0, 1, 2, 3]])]
    assert arrays.cell_sets["both"].tolist() == arrays.cell_sets["ends"].tolist() == [0]
    assert "loose" not in arrays.cell_sets
    assert len(arrays.facet_sets["skin"][0]) == 1
    (note,) = arrays.notes
    assert (note.code, note.where, note.value) == ("left-out-elements", "bodies.0.mesh.file", 1)
    assert note.message == (
        f'bodies.0.mesh.file = "{tmp_path / "deck.inp"}": left out 1 {kind} element, which fill no '
        "space"
    )


def test_what_is_left_out_is_counted_by_kind(tmp_path):
    text = f"{HEAD}*ELEMENT, TYPE=SPRINGA\n7, 1, 9\n8, 2, 9\n*ELEMENT, TYPE=B31\n9, 1, 2\n"
    (note,) = read(tmp_path, text).notes
    assert "left out 2 SPRINGA elements, 1 B31 element, which" in note.message
    assert note.value == 3


def test_a_deck_of_beams_alone_holds_no_cells(tmp_path):
    nodes = HEAD.partition("*ELEMENT")[0]
    text = f"{nodes}*ELEMENT, TYPE=B31\n1, 1, 2\n2, 2, 3\n"
    assert "holds no cells: left out 2 B31 elements, which fill no" in refusal(tmp_path, text)


def test_a_deck_of_lines_is_of_two_dimensions_at_the_least(tmp_path):
    (tmp_path / "deck.inp").write_text("*NODE\n1,0,0\n2,1,0\n*ELEMENT, TYPE=T3D2\n1,1,2\n")
    assert body_dimension(tmp_path / "deck.inp", key="bodies.0.mesh") == 2


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("2, 1., 0., 0.", "2, 1., , 0.", "line 3, column 8: a number is missing"),
        ("2, 1., 0., 0.", "2, 1.,  x, 0.", 'line 3, column 9: "x" is no number'),
        ("2, 1., 0., 0.", ", 1., 0., 0.", "line 3, column 1: a whole number is missing"),
        ("1, 1, 2, 3, 4", "1, 1, , 3, 4", "line 8, column 7: a whole number is missing"),
        ("1, 1, 2, 3, 4", "1, 1, 2., 3, 4", 'line 8, column 7: "2." is no whole number'),
    ],
)
def test_an_empty_or_misspelt_field_is_told_with_line_and_column(tmp_path, old, new, told):
    """Symptom guarded against: "could not convert string to float: ''", and no place."""
    assert told in refusal(tmp_path, HEAD.replace(old, new))


def test_a_field_of_an_included_file_is_told_with_its_name(tmp_path):
    (tmp_path / "nodes.inc").write_text("*NODE\n1, 0., 0., 0.\n2, , 1.\n")
    message = refusal(tmp_path, "*INCLUDE, INPUT=nodes.inc\n*ELEMENT, TYPE=C3D4\n1,1,2,1,2\n")
    assert "line 3 of nodes.inc, column 4: a number is missing" in message


def test_numbers_in_the_notation_of_fortran_and_indented_keywords_are_read(tmp_path):
    text = HEAD.replace("2, 1., 0., 0.", "2, 1.D0, 0.d+0, 0.").replace("*ELEMENT", "  *ELEMENT")
    np.testing.assert_array_equal(read(tmp_path, text).points[1], [1.0, 0.0, 0.0])


def test_empty_fields_at_the_end_of_a_line_are_no_fields(tmp_path):
    text = HEAD.replace("1, 1, 2, 3, 4", "1, 1, 2,\n3, 4, , ")
    assert read(tmp_path, text).blocks[0][1].tolist() == [[0, 1, 2, 3]]


def test_the_sides_of_shells_make_surfaces(tmp_path):
    text = f"{HEAD}*ELEMENT, TYPE=S3, ELSET=skin\n5, 2, 3, 4\n*SURFACE, NAME=slope\nskin, SPOS\n"
    arrays = read(tmp_path, text)
    assert arrays.facet_sets["slope"][0].tolist() == [[1, 2, 3]]
