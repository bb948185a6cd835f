"""Friction by laws is audited: runs are confirmed, a law that is not that of the run is found."""

import shutil

import h5py
import pytest
from rubbing import LAWS, rubbing

import carom


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Run a law once and return its directory."""
    done = {}

    def directory(name):
        if name not in done:
            done[name] = tmp_path_factory.mktemp("law")
            # No longer than a law is known by: every change audits all steps again. A node that
            # sticks is pulled as much as it may be for the first time after 0.1 s.
            end = 0.14 if name == "static and kinetic" else 0.06
            case = rubbing(LAWS[name], "gap", "theta")
            case = case.with_overrides([f"analysis.end_time={end}"])
            carom.run(case, out=done[name])
        return done[name]

    return directory


@pytest.mark.parametrize("name", LAWS)
def test_every_law_is_confirmed(results, name):
    audit = carom.audit(results(name))
    assert audit.refuted == ()
    checks = {check.name: check for check in audit.checks}
    assert checks["Coulomb: slip"].count > 150
    assert checks["Coulomb: slip"].figure < 1e-10
    assert not any("laws remember" in left.what for left in audit.unchecked)


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("static and kinetic", "kinetic = 0.3", "kinetic = 0.3003"),
        ("static and kinetic", "static = 0.6", "static = 0.5"),
        ("Stribeck", "speed = 0.1", "speed = 0.1001"),
        ("Stribeck", "viscous = 0.2", "viscous = 0.2002"),
        ("weakening", "distance = 0.02", "distance = 0.02002"),
        ("rate and state", "direct = 0.05", "direct = 0.05005"),
        ("rate and state", "evolution = 0.06", "evolution = 0.06006"),
        ("rate and state", "distance = 0.01", "distance = 0.01001"),
        ("speed and distance", "v/0.5", "v/0.5005"),
        ("speed and distance", "s/0.03", "s/0.03003"),
        ("pressure", "60/p", "60.06/p"),
    ],
)
def test_a_law_that_is_not_that_of_the_run_is_found(tmp_path, results, name, old, new):
    directory = tmp_path / "changed"
    shutil.copytree(results(name), directory)
    text = (directory / "case.toml").read_text()
    assert old in text
    (directory / "case.toml").write_text(text.replace(old, new, 1))
    assert {"Coulomb: slip", "Coulomb: cone"} & {c.name for c in carom.audit(directory).refuted}


@pytest.mark.parametrize("name", ["weakening", "rate and state", "speed and distance"])
def test_what_a_law_remembers_is_said_not_to_be_known_where_steps_are_not_stored(tmp_path, name):
    """Then friction is checked by what the law allows whatever happened before."""
    output = {"history_every": 2e-3, "fields_every": 2e-2, "audit": True}
    carom.run(rubbing(LAWS[name], "gap", "theta", output=output), out=tmp_path)
    audit = carom.audit(tmp_path)
    assert audit.confirmed
    assert any("laws remember" in left.what for left in audit.unchecked)


def test_a_formula_that_python_does_not_read_is_named(tmp_path, results):
    directory = tmp_path / "changed"
    shutil.copytree(results("pressure"), directory)
    text = (directory / "case.toml").read_text()
    (directory / "case.toml").write_text(text.replace("60/p", "060/p"))
    with pytest.raises(carom.InputError, match=r"cannot audit the formula 'min\(0.4, 060/p\)': "):
        carom.audit(directory)


def test_a_reaction_beyond_what_the_law_allows_is_found(tmp_path, results):
    """A tangential reaction of one contact is 0.1 % more than it was."""
    directory = tmp_path / "changed"
    shutil.copytree(results("weakening"), directory)
    with h5py.File(directory / "audit.h5", "r+") as file:
        reactions = file["steps/000020/end/contact_reaction"]
        assert abs(reactions[-1, 0]) > 0.1
        reactions[-1, 0] *= 1.001
    assert "Coulomb: cone" in {check.name for check in carom.audit(directory).refuted}
