"""Commands write where they are told to, and replace nothing that is not theirs."""

import hashlib
import os
import subprocess
import sys

import pytest

from carom import InputError, Scenario, cli
from carom import run as run_scenario

pytestmark = pytest.mark.usefixtures("pictures")

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


LONG = "x" * 300

PLACES = {
    "file": ("out", "out: is a file; choose another --out"),
    "below a file": ("out/deep/er", "out: is a file; choose another --out"),
    "link": ("out", "out: is a link that leads nowhere; choose another --out"),
    "loop": ("out/in", "out: is a link that leads nowhere; choose another --out"),
    "long": (LONG, f"{LONG}: cannot be reached: File name too long; choose another --out"),
    "folder": ("out", "out: has a holidays that is not of a "),
    "files of others": ("out", "out: has a thesis.tex that is not of a "),
}
"""Where no results can be: what is asked for, and what is said."""


def prepared(desk, kind):
    """Put something where the results are to go."""
    there = desk / "out"
    if kind in ("file", "below a file"):
        there.write_text("mine")
    elif kind == "link":
        there.symlink_to("nowhere")
    elif kind == "loop":
        there.symlink_to("out")
    elif kind == "folder":
        (there / "holidays").mkdir(parents=True)
    elif kind == "files of others":
        there.mkdir()
        (there / "thesis.tex").write_text("mine")
    return PLACES[kind]


SWEEP = ("sweep", "case.toml", "--vary", "contact.friction=0.3", "--jobs", "1", "--quiet")


# Symptoms guarded against: "File exists; make room and start again", exit status 1, for a file or a
# link in place of the directory; a folder full of other files was written into.
@pytest.mark.parametrize("kind", PLACES)
@pytest.mark.parametrize("force", [(), ("--force",)])
@pytest.mark.parametrize("words", [("run", "case.toml", "--quiet"), SWEEP])
def test_a_place_for_results_that_is_none_is_refused_in_fitting_words(
    desk, capsys, kind, force, words
):
    out, said = prepared(desk, kind)
    before = tree(desk)
    assert carom(*words, "--out", out, *force) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ")
    assert said in error
    assert error.count("\n") == 1
    assert tree(desk) == before
    if kind in ("link", "loop"):
        assert (desk / "out").is_symlink()


@pytest.mark.parametrize("kind", PLACES)
def test_python_refuses_the_same_places(desk, kind):
    out, said = prepared(desk, kind)
    before = tree(desk)
    for force in (False, True):
        with pytest.raises(InputError) as caught:
            run_scenario(Scenario.from_toml("case.toml"), out=out, force=force)
        assert str(caught.value).startswith(said)
    assert tree(desk) == before


def test_a_name_that_no_system_takes_is_refused():
    with pytest.raises(InputError, match="cannot be made: embedded null byte; choose another"):
        run_scenario(Scenario.from_toml("case.toml"), out="a\0b")


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="root writes everywhere")
def test_a_directory_that_may_not_be_written_to_is_refused(desk, capsys):
    (desk / "out").mkdir(mode=0o500)
    for out in ("out", "out/deep"):
        assert carom("run", "case.toml", "--out", out) == 2
        assert "out: cannot be written to; choose another --out" in capsys.readouterr().err


def test_a_directory_that_may_not_be_written_to_is_named(desk, capsys, monkeypatch):
    monkeypatch.setattr("os.access", lambda path, mode: mode == os.R_OK)
    assert carom("run", "case.toml", "--out", "out") == 2
    assert ".: cannot be written to; choose another --out" in capsys.readouterr().err
    assert carom("new", "drop-test", "made.toml") == 2
    assert "made.toml: . cannot be written to; name another" in capsys.readouterr().err


def test_what_systems_leave_in_a_directory_does_not_count(desk):
    (desk / "out").mkdir()
    (desk / "out" / ".gitignore").write_text("*")
    assert carom("run", "case.toml", "--out", "out", "--quiet") == 0


def test_what_was_put_beside_results_stays(desk):
    assert carom("run", "case.toml", "--out", "out", "--quiet") == 0
    (desk / "out" / "notes.txt").write_text("mine")
    assert carom("run", "case.toml", "--out", "out", "--quiet", "--force") == 0
    assert (desk / "out" / "notes.txt").read_text() == "mine"


def test_a_study_goes_on_where_it_has_begun_and_keeps_to_its_folders(desk, capsys):
    words = (*SWEEP, "--out", "study")
    assert carom(*words) == 0
    for name in ("sweep.csv", "sweep.png"):
        (desk / "study" / name).unlink()
    assert carom(*words) == 0  # as after a study that was killed
    (desk / "study" / "sweep.csv").unlink()
    (desk / "study" / "notes.txt").write_text("mine")
    capsys.readouterr()
    assert carom(*words) == 2
    assert "study: has a notes.txt that is not of a study" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda file: file.symlink_to("nowhere"), "is a link that leads nowhere; name another"),
        (lambda file: file.mkdir(), "is a directory; name a file in it"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_in_fitting_words(desk, capsys, make, said):
    make(desk / "made")
    assert carom("run", "case.toml", "--out", "out", "--quiet") == 0
    for words in (("new", "drop-test", "made"), ("report", "out", "--out", "made")):
        for force in ((), ("--force",)):
            assert carom(*words, *force) == 2
            assert f"error: made: {said}" in capsys.readouterr().err
    (desk / "note").write_text("mine")
    assert carom("new", "drop-test", "note/case.toml") == 2
    assert "note/case.toml: note is a file; name a directory" in capsys.readouterr().err


# Symptom guarded against: carom.run replaced results where the command refuses.
def test_a_second_run_in_python_is_refused_unless_it_says_force(desk):
    scenario = Scenario.from_toml("case.toml")
    run_scenario(scenario, out="out")
    before = tree(desk)
    with pytest.raises(InputError, match=r"has results of a run; --force .*force=True") as caught:
        run_scenario(scenario, out="out")
    assert "\n" not in str(caught.value)
    assert tree(desk) == before
    assert run_scenario(scenario, out="out", force=True).summary["status"] == "completed"
    assert run_scenario(scenario, out="out", resume=True).summary["status"] == "completed"


# Symptom guarded against: "No module named carom.__main__".
def test_the_command_is_a_module_too():
    python = [sys.executable, "-m", "carom"]
    shown = subprocess.run([*python, "--help"], capture_output=True, text=True, check=True)
    assert "Usage: carom " in shown.stdout
    wrong = subprocess.run(
        [*python, "check", "no.toml"], capture_output=True, text=True, check=False
    )
    assert wrong.returncode == 2
    assert wrong.stderr.startswith("error: no.toml: ")
