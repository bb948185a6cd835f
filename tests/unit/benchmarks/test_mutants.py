"""The list of deliberate errors is about the code as it is."""

import importlib
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).parents[3] / "benchmarks"


@pytest.fixture(scope="module")
def listed():
    sys.path.insert(0, str(BENCHMARKS))
    try:
        return importlib.import_module("mutants.__main__")
    finally:
        sys.path.remove(str(BENCHMARKS))


def test_every_error_can_be_made(listed):
    mutants = listed.mutants()
    assert len(mutants) >= 20
    assert len({mutant.name for mutant in mutants}) == len(mutants)
    for mutant in mutants:
        text = (listed.ROOT / mutant.file).read_text(encoding="utf-8")
        assert text.count(mutant.find) == 1, f"{mutant.name}: {mutant.find!r} in {mutant.file}"
        assert mutant.replace != mutant.find


def test_the_first_test_that_fails_is_named_with_its_crate(listed):
    said = """
     Running unittests src/lib.rs (target/release/deps/carom-0123abcd)
test books::fails ... FAILED
     Running tests/suite/main.rs (target/release/deps/suite-0123abcd)
test ledger::fails ... FAILED
     Running unittests src/lib.rs (target/release/deps/carom_friction-0123abcd)
test cone::holds ... ok
test cone::fails ... FAILED
"""
    assert listed._failed(said) == [
        ("carom", "books::fails"),
        ("carom", "ledger::fails"),
        ("carom-friction", "cone::fails"),
    ]


def test_errors_that_survive_and_those_that_do_not_are_in_the_table(listed):
    verdicts = [
        listed.Verdict("a", "crates/carom/src/step/commit.rs", "carom", "ledger::fails", 1.0),
        listed.Verdict("b", "python/carom/case/output.py", "nobody", "", 2.0),
    ]
    assert listed.table(verdicts).splitlines()[2:] == [
        "| a | [commit.rs](../crates/carom/src/step/commit.rs) | carom | `ledger::fails` |",
        "| b | [output.py](../python/carom/case/output.py) | nobody |  |",
    ]
