"""The JSON Schema of the case file says what carom says, as far as it can."""

import json
from pathlib import Path

import jsonschema
import pytest
import tomlkit

import carom
from carom import cli
from carom.case import case_file, overrides
from carom.case.schema import case_file_schema

ROOT = Path(__file__).parents[3]
CASES = sorted((ROOT / "examples").glob("*.toml"))


@pytest.fixture(scope="module")
def validator():
    schema = case_file_schema()
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.stem)
def test_the_examples_are_valid(validator, case):
    validator.validate(case_file.read(case))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.stem)
def test_a_case_with_every_default_written_out_is_valid(validator, case):
    text = carom.Scenario.from_toml(case).to_toml(complete=True)
    validator.validate(tomlkit.parse(text).unwrap())


REFUSED = [
    "analysis.time_stp=1",
    "analysis.time_step=0",
    "analysis.time_step='1e-3'",
    "analysis.scheme={}",
    "analysis.scheme={kind='theta', theta=1.5}",
    "bodies=[]",
    "bodies.0.mesh={centre=[0.0, 0.0], radius=1.0, divisions=4}",
    "bodies.0.mesh={kind='disc', centre=[0.0, 0.0, 0.0], radius=1.0, divisions=4}",
    "bodies.0.mesh.divisions=1.5",
    "bodies.0.mesh.cell='hex8'",
    "bodies.0.velocity=[1.0]",
    "materials.elastic.kind='jelly'",
    "materials.elastic.poisson=0.5",
    "obstacles.0.normal=[1.0, 0.0, 0.0, 0.0]",
    "contact.friction=-0.1",
    "contact.solver.kind='magic'",
    "loads=[{kind='pressure', body='left'}]",
]


@pytest.mark.parametrize("override", REFUSED)
def test_what_carom_refuses_by_type_or_range_the_schema_refuses(validator, examples, override):
    case = case_file.read(examples / "two_cylinders.toml")
    case["contact"].setdefault("solver", {})
    spoilt = overrides.apply(case, [override])
    with pytest.raises(carom.InputError):
        carom.Scenario.from_dict(spoilt)
    assert not validator.is_valid(spoilt)


def test_tables_that_need_not_say_their_kind(validator, box):
    del box["analysis"]["kind"]
    box["bodies"][0]["mesh"] = {"file": "part.msh", "scale": 1e-3}
    validator.validate(box)


def test_keys_are_described_as_in_the_reference(validator):
    young = validator.schema["definitions"]["NeoHookean"]["properties"]["young"]
    assert young["description"] == "Young's modulus of small strains [Pa]."


def test_the_command_prints_it_and_the_committed_copy_is_the_same(capsys):
    with pytest.raises(SystemExit):
        cli.app(["schema"], prog_name="carom")
    printed = json.loads(capsys.readouterr().out)
    kept = json.loads((ROOT / "docs" / "carom.schema.json").read_text(encoding="utf-8"))
    assert printed == kept == case_file_schema()


def test_the_page_of_the_case_file_has_the_types_of_the_schema():
    """Symptoms guarded against: `dimension` a "string", and "a number in 2D in 3D"."""
    page = (Path(__file__).parents[3] / "docs/case-file.md").read_text(encoding="utf-8")
    rows = {row.split("|")[1].strip(): row for row in page.splitlines() if row.startswith("| `")}
    assert "| integer |  | `2` | `2`, `3` |" in rows["`dimension`"]
    assert "a number in 2D, a vector in 3D" in rows["`spin`"]
    assert "in 2D in 3D" not in page


def test_a_case_with_patterns_is_valid(validator):
    page = (ROOT / "docs" / "how-to" / "many-bodies.md").read_text(encoding="utf-8")
    text = page.partition("```toml\n")[2].partition("```")[0]
    case = tomlkit.parse(text).unwrap()
    validator.validate(case)
    complete = carom.Scenario.from_dict(case).to_toml(complete=True)
    validator.validate(tomlkit.parse(complete).unwrap())
    case["patterns"][0]["at"]["counts"] = [1, 1]
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(case)
