import pytest

from carom import InputError
from carom.friction import read, read_record, write


def test_the_content_tells_the_format(tmp_path, problem):
    write(problem, tmp_path / "a.hdf5")
    write(problem, tmp_path / "b.dat")
    (tmp_path / "a.hdf5").rename(tmp_path / "a.dat")
    (tmp_path / "b.dat").rename(tmp_path / "b.hdf5")
    assert read(tmp_path / "a.dat").contacts == read(tmp_path / "b.hdf5").contacts == 12
    assert read_record(tmp_path / "b.hdf5").title == "b"


def test_the_suffix_tells_what_is_written(tmp_path, problem):
    with pytest.raises(InputError, match=r"problem.csv: the suffix says the format.*\.hdf5"):
        write(problem, tmp_path / "problem.csv")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("path", ["absent.hdf5", "."])
def test_what_cannot_be_opened_is_bad_input(path):
    with pytest.raises(InputError, match=f"^{path}: cannot be read: "):
        read(path)
