import h5py
import numpy as np
import pytest
import scipy.sparse as sp

from carom import InputError
from carom.friction import GlobalProblem, Problem, read, read_record, solve, write

GLOBAL_ARRAYS = ("m_starts", "m_rows", "m_values", "h_starts", "h_rows", "h_values", "f", "b", "mu")


@pytest.fixture
def local_file(tmp_path, problem):
    write(problem, tmp_path / "local.hdf5", guess=np.ones_like(problem.q), title="Grains")
    return tmp_path / "local.hdf5"


@pytest.fixture
def global_file(tmp_path, global_problem):
    write(global_problem, tmp_path / "global.hdf5", guess=np.ones_like(global_problem.b))
    return tmp_path / "global.hdf5"


def test_a_local_problem_is_read_as_it_was_written(local_file, problem):
    found = read(local_file)
    assert isinstance(found, Problem)
    for name in ("starts", "columns", "blocks", "q", "mu"):
        assert np.array_equal(getattr(found, name), getattr(problem, name))


def test_a_global_problem_is_read_as_it_was_written(global_file, global_problem):
    found = read(global_file)
    assert isinstance(found, GlobalProblem)
    for name in GLOBAL_ARRAYS:
        assert np.array_equal(getattr(found, name), getattr(global_problem, name)), name


def test_guess_solution_and_title_come_along(tmp_path, problem, global_problem):
    answer = solve(problem)
    path = tmp_path / "answered.h5"
    write(problem, path, guess=np.zeros(36), solution=answer, title="Tas", description="grès")
    record = read_record(path)
    assert (record.title, record.description) == ("Tas", "grès")
    assert np.array_equal(record.guesses[0].motions, problem.q)
    assert np.array_equal(record.solution.reactions, answer.reactions)
    assert solve(record.problem, guess=record.solution.reactions).iterations == 0

    r = np.ones_like(global_problem.b)
    write(global_problem, path, solution=r)
    found = read_record(path).solution
    assert found.velocities == pytest.approx(global_problem.velocities(r))
    assert found.motions == pytest.approx(global_problem.motions(r))


def test_the_layout_is_that_of_fclib(local_file, global_file):
    with h5py.File(local_file) as file:
        root = file["fclib_local"]
        assert {name: root["W"][name].dtype.kind for name in root["W"]} == {
            **dict.fromkeys(("m", "n", "nz", "nzmax", "i", "p"), "i"),
            "x": "f",
        }
        assert all(root["W"][name].dtype == np.int32 for name in ("m", "nz", "i", "p"))
        assert root["spacedim"].shape == root["W/m"].shape == (1,)
        assert root["W/nz"][0] == -2
        assert root["W/x"].shape == root["W/i"].shape == (root["W/nzmax"][0],)
        assert root["W/p"].shape == (root["W/m"][0] + 1,)
        assert set(root["vectors"]) == {"q", "mu"}
        assert root["info/title"][()] == b"Grains"
        # C programs look for the zero byte.
        assert root["info/title"].id.get_type().get_size() == len("Grains") + 1
        assert root["info/title"].id.get_type().get_strpad() == h5py.h5t.STR_NULLTERM
        assert file["guesses/number_of_guesses"][0] == 1
        assert set(file["guesses/1"]) == {"r", "u"}
    with h5py.File(global_file) as file:
        root = file["fclib_global"]
        assert set(root) == {"M", "H", "vectors", "info", "spacedim"}
        assert set(root["vectors"]) == {"f", "w", "mu"}
        assert root["H/m"][0] == root["M/n"][0]
        assert set(file["guesses/1"]) == {"r", "u", "v"}


@pytest.mark.parametrize("kind", ["columns", "rows", "triplets", "padded triplets"])
@pytest.mark.parametrize(("integer", "scalars"), [(np.int32, (1,)), (np.int64, ())])
def test_every_storage_of_a_matrix_is_read(local_file, problem, kind, integer, scalars):
    W = problem.matrix()
    with h5py.File(local_file, "r+") as file:
        group = file["fclib_local/W"]
        for name in ("i", "p", "x", "nz", "m", "n"):
            del group[name]
        if kind in {"columns", "rows"}:
            stored = W.tocsc() if kind == "columns" else W.tocsr()
            nz = {"columns": -1, "rows": -2}[kind]
            p, i, x = stored.indptr, stored.indices, stored.data
        else:
            stored = W.tocoo()
            # Entries that are given twice add up.
            p, i = np.repeat(stored.col, 2), np.repeat(stored.row, 2)
            x, nz = np.repeat(stored.data / 2, 2), 2 * stored.nnz
            if kind == "padded triplets":
                p, i, x = (np.append(array, [77, 77]) for array in (p, i, x))
        group["p"], group["i"], group["x"] = p.astype(integer), i.astype(integer), x
        group["nz"] = np.full(scalars, nz, dtype=integer)
        group["m"] = group["n"] = np.full(scalars, W.shape[0], dtype=integer)
    assert read(local_file).matrix().toarray() == pytest.approx(W.toarray(), abs=1e-15)


def spoil(path, name, value):
    with h5py.File(path, "r+") as file:
        del file[name]
        if value is not None:
            file[name] = value


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("fclib_local", None, "has no group fclib_local or fclib_global (but guesses)"),
        ("fclib_local/W", None, "fclib_local/W: required group is missing"),
        ("fclib_local/W/x", None, "fclib_local/W/x: required dataset is missing"),
        ("fclib_local/vectors/q", None, "fclib_local/vectors/q: required dataset is missing"),
        ("fclib_local/W/x", [1.0, 2.0], "fclib_local/W/x has 2 entries: must be "),
        ("fclib_local/W/x", ["a"], "fclib_local/W/x: has object data; must be numbers"),
        ("fclib_local/W/i", [0.5], "fclib_local/W/i: has float64 data; must be integers"),
        ("fclib_local/W/p", [0, 1], "fclib_local/W/p has 2 entries: must be 37"),
        ("fclib_local/W/p", np.arange(37)[::-1], "fclib_local/W/p: must begin with 0 and never"),
        ("fclib_local/W/m", [[36, 36]], "fclib_local/W/m has 2 entries: must be one integer"),
        ("fclib_local/W/nz", [-3], "fclib_local/W: m = 36, n = 36, nz = -3: must be sizes"),
        ("fclib_local/spacedim", [4], "fclib_local/spacedim = 4: must be 2 or 3"),
        (
            "fclib_local/spacedim",
            [2],
            "fclib_local/vectors/q has 36 entries: must be 24, 2 (spacedim)",
        ),
        (
            "fclib_local/vectors/mu",
            [0.1] * 11,
            "fclib_local/vectors/q has 36 entries: must be 33, 3 (s",
        ),
        ("fclib_local/vectors/mu", [-0.1] * 12, "mu[0] = -0.1: must be at least 0"),
        ("fclib_local/vectors/q", [np.nan] * 36, "fclib_local/vectors/q[0] = nan: must be finite"),
    ],
)
def test_what_is_wrong_in_a_file_is_named(local_file, name, value, message):
    spoil(local_file, name, value)
    with pytest.raises(InputError) as caught:
        read(local_file)
    assert str(caught.value).startswith(f"{local_file}: {message}")


def test_an_index_out_of_range_is_named(local_file):
    with h5py.File(local_file, "r+") as file:
        file["fclib_local/W/i"][5] = 36
    with pytest.raises(InputError, match=r"fclib_local/W/i\[5\] = 36: must be from 0 to 35"):
        read(local_file)


def test_a_guess_of_another_problem_is_named(local_file):
    spoil(local_file, "guesses/1/r", np.zeros(3))
    assert read(local_file).contacts == 12
    with pytest.raises(InputError, match=r"guesses/1/r has shape \[3\]: must be \[12, 3\]"):
        read_record(local_file)


@pytest.mark.parametrize(("form", "matrix"), [("local", "V"), ("global", "G")])
def test_bilateral_constraints_are_refused(request, form, matrix):
    path = request.getfixturevalue(f"{form}_file")
    with h5py.File(path, "r+") as file:
        file.create_group(f"fclib_{form}/{matrix}")
    with pytest.raises(InputError, match=f"fclib_{form}/{matrix}: bilateral constraints are not"):
        read(path)


@pytest.mark.parametrize("kept", [0.1, 0.5, 0.95])
def test_a_file_cut_short_is_bad_input(local_file, kept):
    whole = local_file.read_bytes()
    local_file.write_bytes(whole[: int(kept * len(whole))])
    with pytest.raises(InputError, match="is no readable HDF5 file, perhaps cut short"):
        read(local_file)


def test_what_was_written_replaces_the_file_whole(tmp_path, problem):
    path = tmp_path / "problem.hdf5"
    path.write_text("old")
    write(problem, path)
    assert read(path).contacts == problem.contacts
    assert list(tmp_path.iterdir()) == [path]


def test_what_cannot_be_written_leaves_nothing_behind(tmp_path, problem):
    """Symptom guarded against: part of the new file stayed beside the old one."""
    path = tmp_path / "one.hdf5"
    path.write_text("old")
    with pytest.raises(ValueError, match="surrogates"):
        write(problem, path, title="\ud800")
    assert [file.name for file in tmp_path.iterdir()] == ["one.hdf5"]
    assert path.read_text() == "old"


def test_problems_of_one_dimension_come_back(tmp_path):
    write(Problem(np.eye(2), np.zeros((2, 1)), [0.0, 0.0]), tmp_path / "flat.h5")
    assert read(tmp_path / "flat.h5").dimension == 1


def test_no_contacts_come_back(tmp_path):
    write(Problem(sp.csr_array((0, 0)), np.zeros((0, 2)), []), tmp_path / "none.h5")
    assert read(tmp_path / "none.h5").contacts == 0


def test_velocities_of_a_guess_must_be_those_of_the_problem(global_file, global_problem):
    spoil(global_file, "guesses/1/v", [1.0])
    with pytest.raises(
        InputError, match=rf"guesses/1/v has 1 entry: must be {global_problem.dofs}"
    ):
        read_record(global_file)
