"""What the shell offers when a word of a command is completed."""

import pytest

from carom import cli
from carom.cli import complete


@pytest.fixture
def folder(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for name in ("part.toml", "part2.toml", "part.msh", ".hidden.toml"):
        (tmp_path / name).touch()
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "case.toml").touch()
    return tmp_path


def test_case_files_and_directories(folder):
    assert list(complete.case_files("part")) == ["part.toml", "part2.toml", "parts/"]
    assert list(complete.case_files("parts/")) == ["parts/case.toml"]
    assert list(complete.case_files(f"{folder}/part2")) == [f"{folder}/part2.toml"]
    assert list(complete.case_files(".h")) == [".hidden.toml"]
    assert list(complete.case_files("absent/")) == []


def test_results_are_directories_with_a_case(folder):
    (folder / "partial").mkdir()
    assert list(complete.results("part")) == ["partial/", "parts"]


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("carom new d", ["drop-test"]),
        ("carom run part.", ["part.toml"]),
        ("carom plot parts", ["parts"]),
        ("carom new mesh-file --unit m", ["m", "mm"]),
    ],
)
def test_bash_is_answered(folder, monkeypatch, capsys, words, offered):
    monkeypatch.setenv("_CAROM_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(words.split()) - 1))
    with pytest.raises(SystemExit) as caught:
        cli.app([], prog_name="carom")
    assert not caught.value.code
    assert capsys.readouterr().out.split() == offered
