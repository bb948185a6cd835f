"""Numbers of a case that are allowed one by one, and that no computer can calculate with."""

import copy
import random

import pytest
from typer.testing import CliRunner

import carom
from carom import InputError, Scenario, cli
from carom.doctor import examine
from restarting import CASE

EXTREMES = (5e-324, 1e-308, 1e-160, 1e-30, 1e30, 1e160, 1e308, 1.7976931348623157e308)

OBSTACLE = {"name": "ball", "kind": "sphere", "centre": [9.0, 9.0], "radius": 1.0}


def changed(key, value):
    """Return the case with one number replaced."""
    scenario = Scenario.from_dict({**CASE, "obstacles": [*CASE["obstacles"], OBSTACLE]})
    return scenario.with_values({key: value})


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        (
            "materials.elastic.density",
            1e-308,
            r"^bodies\.0: the wave speed of left is infinite for a computer; check .* density "
            r"\(1e-308 kg/m³\) of materials\.elastic",
        ),
        ("materials.elastic.young", 1.7e308, "the wave speed of left is infinite"),
        ("materials.elastic.young", 5e-324, "the wave speed of left is zero|is infinite"),
        ("bodies.0.velocity", [1e160, 0.0], "^bodies: the initial energy is not finite; check"),
        ("obstacles.1.centre", [1e160, 9.0], "^contact: the distance of left and ball is infinite"),
        ("contact.certificate_tolerance", 1e308, "certificate_tolerance = .*: must be at most 1"),
    ],
)
# Symptom guarded against: TypeError: '<=' not supported between 'float' and 'NoneType'.
def test_what_overflows_is_said_in_a_line(tmp_path, key, value, message):
    def refused(asked):
        with pytest.raises(InputError, match=message) as caught:
            asked()
        assert "\n" not in str(caught.value)

    refused(lambda: carom.check(changed(key, value)))
    refused(lambda: carom.run(changed(key, value), out=tmp_path / "out"))
    assert not (tmp_path / "out").exists()


def numbers(part, path=""):
    """Yield the dotted keys of the numbers of a case."""
    entries = part.items() if isinstance(part, dict) else enumerate(part)
    for name, entry in entries:
        key = f"{path}{name}"
        if isinstance(entry, dict | list):
            yield from numbers(entry, f"{key}.")
        elif isinstance(entry, float):
            yield key


def sample(seed, count):
    """Draw cases in which one number or two are extreme."""
    draw = random.Random(seed)
    keys = list(numbers({**copy.deepcopy(CASE), "obstacles": [OBSTACLE]}))
    keys = [key.replace("obstacles.0", "obstacles.1") for key in keys]
    for _ in range(count):
        some = draw.sample(keys, draw.choice((1, 2)))
        yield {key: draw.choice(EXTREMES) * draw.choice((1.0, 1.0, -1.0)) for key in some}


@pytest.mark.parametrize("values", list(sample(1, 60)), ids=str)
def test_a_case_with_extreme_numbers_is_checked_or_refused_in_a_line(tmp_path, values):
    case = Scenario.from_dict({**CASE, "obstacles": [*CASE["obstacles"], OBSTACLE]})
    (tmp_path / "case.toml").write_text(case.to_toml())
    sets = [word for key, value in values.items() for word in ("--set", f"{key}={value!r}")]
    done = CliRunner().invoke(cli.app, ["check", str(tmp_path / "case.toml"), *sets])
    assert done.exit_code in (0, 2), done.output
    assert done.exception is None or isinstance(done.exception, SystemExit)
    if done.exit_code == 2:
        assert done.output.startswith("error: ")
        assert done.output.count("\n") == 1


def test_the_doctor_finds_what_overflows():
    diagnosis = examine(changed("materials.elastic.density", 1e-308))
    assert [finding.level for finding in diagnosis.findings] == ["error"]
    assert "wave speed of left is infinite" in diagnosis.findings[0].what
