"""``carom restitution``: curves of what an impact did over what was varied."""

import csv

import pytest

import carom
from carom import cli
from carom.errors import InputError
from carom.sweep.impacts import names_of
from carom.sweep.impacts_figure import impacts_figure

DROPPED = """\
[analysis]
end_time = 0.9
time_step = 1e-3
gravity = [0.0, -9.81]

[output]
fields_every = 0.9

[[bodies]]
kind = "rigid"
name = "ball"
density = 1.0
mesh = { kind = "disc", centre = [0.0, 1.1], radius = 1.0, divisions = 4 }
round = true
velocity = [0.4, 0.0]

[[obstacles]]
kind = "plane"
name = "floor"
point = [0.0, 0.0]
normal = [0.0, 1.0]

[contact]
condition = "endpoint"
friction = 0.0
restitution = 0.5
"""


@pytest.fixture
def case(tmp_path):
    file = tmp_path / "dropped.toml"
    file.write_text(DROPPED)
    return file


def restitution(*arguments):
    with pytest.raises(SystemExit) as ended:
        cli.app(["restitution", *map(str, arguments)], prog_name="carom")
    return ended.value.code


def table(directory):
    with (directory / "restitution.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_rigid_ball_bounces_as_high_as_each_coefficient_says(capsys, tmp_path, case):
    out = tmp_path / "study"
    values = "contact.restitution=0.25:0.75:3"
    assert restitution(case, "--vary", values, "--out", out, "--jobs", 1) == 0
    said = capsys.readouterr().out
    assert "tangential" in said
    rows = table(out)
    assert [float(row["contact.restitution"]) for row in rows] == [0.25, 0.5, 0.75]
    for row in rows:
        given = float(row["contact.restitution"])
        assert float(row["restitution"]) == pytest.approx(given, abs=1e-2)
        assert float(row["tangential_restitution"]) == pytest.approx(-1.0, abs=1e-9)
        assert row["pair"] == "ball|floor"
        assert float(row["sliding"]) == pytest.approx(0.4)
        assert float(row["angle"]) == pytest.approx(15.9, abs=0.3)
        assert float(row["plastic"]) == 0.0
    assert (out / "restitution.png").read_bytes().startswith(b"\x89PNG")
    assert (out / "sweep.csv").is_file()
    # The second impact is slower, and the runs are there already.
    again = restitution(
        *(case, "--vary", values, "--out", out, "--impact", 2, "--between", "floor,ball")
    )
    assert again == 0
    second = table(out)
    assert float(second[1]["approach"]) == pytest.approx(0.5 * float(rows[1]["approach"]), rel=2e-2)
    assert restitution(case, "--vary", values, "--out", out, "--impact", 500) == 0
    assert {row["approach"] for row in table(out)} == {""}


def test_whose_impact_is_meant_is_checked_before_anything_runs(case):
    scenario = carom.Scenario.from_toml(case)
    assert names_of(scenario, "ball, floor") == {"ball", "floor"}
    with pytest.raises(InputError, match="--between wall: no such body or obstacle"):
        names_of(scenario, "ball,wall")
    with pytest.raises(InputError, match="--between ball: give two names, such as ball,floor"):
        names_of(scenario, "ball")


def test_curves_are_told_apart_by_the_other_keys():
    nothing = dict.fromkeys(("vibration", "strain", "friction", "plastic", "viscous"), 0.0)
    rows = [
        {"speed": speed, "law": law, "restitution": e, "tangential_restitution": None, **nothing}
        for speed, law, e in ((1.0, "a", 0.9), (2.0, "a", 0.8), (1.0, "b", 0.7), (2.0, "b", None))
    ]
    rows[0]["friction"] = 0.1
    picture = impacts_figure("Bounce", ["speed", "law"], rows)
    first, _, third, fourth = picture.axes
    assert [line.get_label() for line in first.lines] == ["law = a", "law = b"]
    assert [list(line.get_ydata()) for line in first.lines] == [[0.9, 0.8], [0.7]]
    assert third.get_ylabel() == "work of friction [J]"
    assert not fourth.get_visible()
