import numpy as np
import pytest

from carom import InputError
from carom.friction import GlobalProblem, Problem, read, write

DENSE = """2
2
0
4
4
4 4
 2.0 0.1 0.0 0.0
 0.1 2.0 0.0 0.5
 0.0 0.0 1.0 0.0
 0.0 0.5 0.0 1.0
 -1.0 0.25 -2.0 0.5
 0.3 0.4
"""

BLOCKS = """2
2
1
4
4
4
2
2
2 4
2 4
3
4
0 2 4
0 1 0 1
0
 2.0 0.1 0.1 2.0
1
 0.0 0.0 0.0 0.5
2
 0.0 0.0 0.0 0.5
3
 1.0 0.0 0.0 1.0
 -1.0 0.25 -2.0 0.5
 0.3 0.4
1
"""

COLUMNS = """2
2
2
4
4
2
CSparse Version 3.1.9, May 4, 2016.  Copyright (c) Timothy A. Davis, 2006-2016
4-by-4, nzmax: 8 nnz: 8, 1-norm: 2.6
    col 0 : locations 0 to 1
      0 : 2
      1 : 0.1
    col 1 : locations 2 to 4
      0 : 0.1
      1 : 2
      3 : 0.5
    col 2 : locations 5 to 5
      2 : 1
    col 3 : locations 6 to 7
      1 : 0.5
      3 : 1
 -1.0 0.25 -2.0 0.5
 0.3 0.4
"""

TRIPLETS = """2
2
2
4
4
1
CSparse Version 3.1.9, May 4, 2016.  Copyright (c) Timothy A. Davis, 2006-2016
triplet: 4-by-4, nzmax: 9 nnz: 9
    0 0 : 1.5
    0 0 : 0.5
    1 0 : 0.1
    0 1 : 0.1
    1 1 : 2
    3 1 : 0.5
    2 2 : 1
    1 3 : 0.5
    3 3 : 1
 -1.0 0.25 -2.0 0.5
 0.3 0.4
"""

GLOBAL = """2
1
0
3
3
3 3
 1 0 0  0 2 0  0 0 4
0
3
2
3 2
 1 2 3
 4 5 6
 0.5 0.25 0.125
 -1 1
 0.3
0
"""

# M has the size of W: that a matrix follows it tells the form.
GLOBAL_AS_WIDE_AS_LOCAL = """2
1
0
2
2
2 2
 1 0 0 2
0
2
2
2 2
 0 1 -1 0
 0.5 0.25
 -1 1
 0.3
"""


def read_text(tmp_path, text):
    path = tmp_path / "problem.dat"
    path.write_text(text)
    return read(path)


@pytest.mark.parametrize("text", [DENSE, BLOCKS, COLUMNS, TRIPLETS])
def test_every_storage_says_the_same(tmp_path, text):
    found = read_text(tmp_path, text)
    assert isinstance(found, Problem)
    assert found.matrix().toarray().tolist() == [
        [2.0, 0.1, 0.0, 0.0],
        [0.1, 2.0, 0.0, 0.5],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.5, 0.0, 1.0],
    ]
    assert found.q.tolist() == [[-1.0, 0.25], [-2.0, 0.5]]
    assert found.mu.tolist() == [0.3, 0.4]


def test_a_second_matrix_makes_a_global_problem_and_is_stored_by_columns(tmp_path):
    found = read_text(tmp_path, GLOBAL)
    assert isinstance(found, GlobalProblem)
    assert found.M.toarray().tolist() == np.diag([1.0, 2.0, 4.0]).tolist()
    assert found.H.toarray().T.tolist() == [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
    assert (found.f.tolist(), found.b.tolist()) == ([0.5, 0.25, 0.125], [[-1.0, 1.0]])


def test_a_global_problem_may_have_as_many_dofs_as_contact_components(tmp_path):
    found = read_text(tmp_path, GLOBAL_AS_WIDE_AS_LOCAL)
    assert isinstance(found, GlobalProblem)
    assert found.H.toarray().tolist() == [[0.0, -1.0], [1.0, 0.0]]


def test_what_is_written_is_read_back(tmp_path, problem, global_problem):
    write(problem, tmp_path / "local.dat")
    found = read(tmp_path / "local.dat")
    for name in ("starts", "columns", "blocks", "q", "mu"):
        assert np.array_equal(getattr(found, name), getattr(problem, name))
    write(global_problem, tmp_path / "global.txt")
    found = read(tmp_path / "global.txt")
    for name in ("m_starts", "m_rows", "m_values", "h_starts", "h_rows", "h_values", "f", "b"):
        assert np.array_equal(getattr(found, name), getattr(global_problem, name)), name


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "line 1, word 1: the text ends where the dimension needs 1 more"),
        ("# Notes\n", "line 1, word 1: '#': is neither HDF5 nor a text of Siconos"),
        ("5\n2\n", "line 1, word 1: '5': is neither HDF5 nor a text of Siconos"),
        ("2\nx\n", "line 2, word 2: 'x': the number of contacts must be an integer"),
        ("2\n1\n7\n", "line 3, word 3: '7': the storage of the first matrix must be 0 (dense)"),
        (DENSE[:-5], "line 12, word 29: the text ends where mu needs 1 more number;"),
        (DENSE.replace("0.25", "O.25"), "line 11, word 25: 'O.25': q must be finite numbers"),
        (DENSE.replace("0.25", "nan"), "line 11, word 25: 'nan': q must be finite numbers"),
        (DENSE.replace("4 4\n 2", "4 5\n 2"), "line 6, word 7: '5': the first matrix must have 4"),
        (DENSE.replace("0.3 0.4", "0.3 -1"), "mu[1] = -1: must be at least 0"),
        (DENSE + " 0.1 0.1", "line 13, word 30: '0.1': 2 words follow the last of mu; rolling"),
        (
            DENSE.replace("2\n2\n0", "2\n3\n0", 1),
            "the first matrix is 4 × 4 and no other follows: must be 6 × 6",
        ),
        (BLOCKS.replace("0 1 0 1", "0 1 0 2"), "line 14, word 21: '2': the block columns of the"),
        (BLOCKS.replace("0 2 4", "0 2 5"), "line 13, word 17: '5': the block starts of the first"),
        (BLOCKS.replace("\n2\n 0.0", "\n7\n 0.0"), "line 19, word 32: '7': must be the number of"),
        (BLOCKS.replace("2 4\n2 4", "2 5\n2 4"), "line 9, word 10: '5': the block rows of the"),
        (BLOCKS[:60], "line 16, word 27: the text ends where the blocks of the first matrix needs"),
        (COLUMNS.replace("3 : 0.5", "4 : 0.5"), "line 15, word 52: '4': an index of the first"),
        (
            COLUMNS.replace("col 2", "col 5"),
            "line 16, word 56: '5': the first matrix must have col",
        ),
        (COLUMNS.replace("nnz: 8", "nnz: 9"), "the first matrix has 8 entries: must be 9"),
        (COLUMNS.replace("4-by-4", "4-by-5"), "line 8, word 19: '4-by-5,': the first matrix must"),
        (TRIPLETS.replace("2 2 : 1", "2 2 : x"), "line 15, word 52: 'x': the first matrix must be"),
        (
            TRIPLETS.replace("2 2 : 1", "2 2 = 1"),
            "line 15, word 51: '=': the first matrix must have",
        ),
        (GLOBAL.replace("3\n2\n3 2", "3\n3\n3 3"), "the first matrix is 3 × 3 and no other foll"),
        (GLOBAL[:-8], "line 15, word 33: the text ends where mu needs 1 more number;"),
    ],
)
def test_what_is_wrong_in_a_text_is_named_with_its_place(tmp_path, text, message):
    with pytest.raises(InputError) as caught:
        read_text(tmp_path, text)
    assert str(caught.value).startswith(f"{tmp_path / 'problem.dat'}: {message}")


def test_bytes_that_are_no_text_are_refused(tmp_path):
    path = tmp_path / "picture.dat"
    path.write_bytes(b"\x89PNG\xff\xfe\x00")
    with pytest.raises(InputError, match="is neither HDF5 nor text"):
        read(path)


def test_a_global_problem_may_have_no_contact(tmp_path):
    text = "2\n0\n0\n1\n1\n1 1\n 2.0\n0\n1\n0\n1 0\n 0.5\n"
    found = read_text(tmp_path, text)
    assert (found.contacts, found.dimension, found.H.shape) == (0, 2, (1, 0))
