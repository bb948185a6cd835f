"""The scripts of benchmarks/ run where carom does, and rewrite only what they are asked for."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
BENCHMARKS = ROOT / "benchmarks"
SCRIPTS = sorted(path.stem for path in BENCHMARKS.glob("*.py"))


@pytest.fixture
def validate(monkeypatch):
    monkeypatch.syspath_prepend(BENCHMARKS)
    monkeypatch.syspath_prepend(ROOT / "tests" / "validation")
    import validate

    return validate


IMPORT = """
import importlib, json, sys, traceback
for name in ('pytest', 'hypothesis', 'jsonschema', 'pandas', 'vtk', 'pyvista'):
    sys.modules[name] = None
sys.path.insert(0, sys.argv[1])
wrong = {}
for script in sys.argv[2:]:
    try:
        importlib.import_module(script)
    except BaseException:
        wrong[script] = traceback.format_exc()
print(json.dumps(wrong))
"""


def test_benchmarks_need_nothing_that_only_tests_need():
    """Symptom guarded against: benchmarks/loads.py stopped, as `make demo` brings no pytest."""
    done = subprocess.run(
        [sys.executable, "-c", IMPORT, BENCHMARKS, *SCRIPTS, "claims.__main__"],
        check=True,
        capture_output=True,
        text=True,
    )
    assert json.loads(done.stdout.splitlines()[-1]) == {}


def test_every_section_of_the_validation_page_has_a_part_that_writes_it(validate):
    """Symptom guarded against: massless bars and layer were pasted, and had no command."""
    page = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
    sections = list(validate.headed(page).values())
    assert len(sections) - 1 == len(validate.PARTS)
    modules = (path.read_text(encoding="utf-8") for path in (BENCHMARKS / "sections").glob("*.py"))
    templates = "".join(modules)
    for heading in list(validate.headed(page))[1:]:
        assert f'"""\\\n{heading}\n' in templates, heading


def test_a_part_of_the_validation_page_is_renewed_alone(validate):
    page = "# Validation\n\n## One\n\n1\n\n### Of one\n\n2\n\n## Two\n\n3\n"
    renewed = validate.renewed(page, "## One\n\n4\n")
    assert renewed == "# Validation\n\n## One\n\n4\n\n## Two\n\n3\n"
    assert validate.renewed(page, "## Three\n\n5\n") == f"{page}\n## Three\n\n5\n"


@pytest.fixture
def sources(tmp_path):
    """A tree of sources, and the package that was made of them after."""
    root, package = tmp_path / "root", tmp_path / "site" / "carom"
    files = {
        root / "crates" / "carom" / "src" / "step" / "mod.rs": 100,
        root / "python" / "carom" / "case" / "body.py": 100,
        package / "case" / "body.py": 200,
        package / "_carom.abi3.so": 200,
    }
    for path, written in files.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("as it is")
        os.utime(path, (written, written))
    return root, package


def test_nothing_is_measured_with_a_carom_of_other_sources(monkeypatch, sources):
    """Symptom guarded against: half an hour of validation measured a version of the day before."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    from same_sources import changed_since_built

    root, package = sources
    assert changed_since_built(root, package) is None
    native = root / "crates" / "carom" / "src" / "step" / "mod.rs"
    os.utime(native, (300, 300))
    assert changed_since_built(root, package) == native
    described = root / "python" / "carom" / "case" / "body.py"
    described.write_text("as it will be")
    assert changed_since_built(root, package) == described
    (package / "case" / "body.py").unlink()
    assert changed_since_built(root, package) == described


def test_the_validations_ask_whose_carom_it_is(monkeypatch, validate):
    def refuse():
        raise SystemExit("other sources")

    monkeypatch.setattr(validate, "refuse_another_carom", refuse)
    monkeypatch.setattr(sys, "argv", ["validate.py", "bars"])
    with pytest.raises(SystemExit, match="other sources"):
        validate.main()
