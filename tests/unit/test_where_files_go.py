"""Commands write where they are told to, and replace nothing that is not theirs."""

import hashlib

import pytest

from carom import cli

CASE = """\
[analysis]
end_time = 0.01
time_step = 1e-3

[materials.soft]
kind = "saint-venant-kirchhoff"
young = 2700.0
poisson = 0.33
density = 1.0

[[bodies]]
name = "disc"
material = "soft"
mesh = { kind = "disc", centre = [0.0, 1.005], radius = 1.0, divisions = 2 }
velocity = [1.0, -2.0]

[[obstacles]]
name = "floor"
kind = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]

[output]
audit = true
"""


@pytest.fixture(autouse=True)
def desk(tmp_path, monkeypatch):
    """A folder for temporary files and a working directory with a case, in one tree."""
    for name in ("tmp", "desk"):
        (tmp_path / name).mkdir()
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    monkeypatch.chdir(tmp_path / "desk")
    (tmp_path / "desk" / "case.toml").write_text(CASE)
    return tmp_path / "desk"


def tree(folder):
    """What is in every file below a folder; None for a folder."""
    return {
        path.relative_to(folder).as_posix(): (
            hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else None
        )
        for path in folder.rglob("*")
    }


def carom(*words):
    """Run a command; return its exit status."""
    with pytest.raises(SystemExit) as caught:
        cli.app([str(word) for word in words], prog_name="carom")
    return caught.value.code or 0


def changed(desk, *words):
    """Run a command that succeeds; return what it made, changed or removed."""
    before = tree(desk.parent)
    assert carom(*words) == 0
    after = tree(desk.parent)
    return {path for path in before | after if before.get(path, 0) != after.get(path, 0)}


def test_a_run_writes_below_out_and_nowhere_else(desk):
    paths = changed(desk, "run", "case.toml", "--out", "out", "--quiet")
    assert "desk/out/summary.json" in paths
    assert all(path.startswith("desk/out") for path in paths)


def test_a_study_writes_below_out_and_nowhere_else(desk):
    words = ("--vary", "contact.friction=0,0.3", "--out", "study", "--jobs", "1")
    paths = changed(desk, "sweep", "case.toml", *words)
    assert {"desk/study/friction=0/summary.json", "desk/study/friction=0.3/summary.json"} <= paths
    assert all(path.startswith("desk/study") for path in paths)


def test_commands_that_only_look_write_nothing(desk):
    assert carom("run", "case.toml", "--out", "out", "--quiet") == 0
    for words in (
        *(("check", "case.toml"), ("doctor", "case.toml"), ("schema",), ("new",)),
        *(("audit", "out"), ("watch", "out")),
    ):
        assert changed(desk, *words) == set(), words


def test_commands_that_draw_and_tell_write_the_files_that_they_name(desk):
    assert carom("run", "case.toml", "--out", "out", "--quiet") == 0
    (desk / "out" / "energy.png").unlink()
    assert changed(desk, "plot", "out") == {"desk/out/energy.png"}
    assert changed(desk, "report", "out") == {"desk/out/report.html"}
    assert changed(desk, "report", "out", "--out", "page.html") == {"desk/page.html"}
    assert changed(desk, "new", "drop-test") == {"desk/drop-test.toml"}


@pytest.mark.parametrize(
    ("words", "there"),
    [
        (("run", "case.toml", "--out", "out", "--quiet"), "out/summary.json"),
        (
            *[("sweep", "case.toml", "--vary", "contact.friction=0.3", "--out", "out")],
            "out/friction=0.3/summary.json",
        ),
        (("new", "drop-test", "made.toml"), "made.toml"),
    ],
)
def test_what_a_command_has_made_it_replaces_with_force_only(desk, capsys, words, there):
    assert carom(*words) == 0
    text = (desk / "case.toml").read_text()
    (desk / "case.toml").write_text(text.replace("0.01\n", "0.012\n"))  # another case
    before = tree(desk)
    assert carom(*words) == 2
    assert "--force" in capsys.readouterr().err
    assert tree(desk) == before
    assert carom(*words, "--force") == 0
    assert (desk / there).exists()


def test_a_page_that_is_there_is_replaced_with_force_only(desk, capsys):
    assert carom("run", "case.toml", "--out", "out", "--quiet") == 0
    (desk / "notes.html").write_text("mine")
    assert carom("report", "out", "--out", "notes.html") == 2
    assert "--force" in capsys.readouterr().err
    assert (desk / "notes.html").read_text() == "mine"
    assert carom("report", "out", "--out", "notes.html", "--force") == 0


def test_results_are_not_put_over_files_of_others(desk):
    (desk / "out").mkdir()
    (desk / "out" / "history.csv").write_text("mine")
    for force in ((), ("--force",)):
        assert carom("run", "case.toml", "--out", "out", "--quiet", *force) == 2
    assert tree(desk / "out").keys() == {"history.csv"}
    assert (desk / "out" / "history.csv").read_text() == "mine"
