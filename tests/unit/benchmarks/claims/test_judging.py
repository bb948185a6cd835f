"""A number that drifted is found, one that only differs by what its kind allows is not."""

import json

import pytest
from claims import __main__ as command
from claims import runs
from claims.judge import judged
from claims.manifest import Claim, Manifest, Section
from claims.pages import Number, Page


def holds(text, *values, kind="exact", **more):
    claim = Claim(page="README.md", text=text, kind=kind, run="a run", **more)
    return [verdict.holds for verdict in judged(claim, list(values))]


def test_physics_may_be_off_by_one_unit_of_the_digits_that_are_shown():
    assert holds("lasts «50.94» µs", 50.945) == [True]
    assert holds("lasts «50.94» µs", 51.20) == [False]
    assert holds("takes «1.7e-2» of it", 0.0175) == [True]
    assert holds("takes «1.7e-2» of it", 0.0191) == [False]


def test_a_tolerance_of_its_own_goes_first():
    assert holds("takes «1.7e-2» of it", 0.0191, relative=0.25) == [True]
    assert holds("is «0» then", 1e-30, relative=0.25) == [False]
    assert holds("is «0» then", 0.05, absolute=0.1) == [True]
    assert holds("drifts by «1e-8»", 5e-8, factor=10.0) == [True]
    assert holds("drifts by «1e-8»", 5e-7, factor=10.0) == [False]


def test_counts_are_equal_and_bounds_are_close():
    assert holds("of «40» it completes «38»", 40, 39, kind="count") == [True, False]
    assert holds("at most «1e-12» J", 2.0e-12, kind="bound") == [False]
    assert holds("at most «3e-12» J", 2.0e-12, kind="bound") == [True]
    assert holds("at most «3e-12» J", 2.0e-15, kind="bound") == [False]


def test_round_off_has_a_size_and_no_sign():
    assert holds("none: «4e-15» m", -9.9e-15, kind="round-off") == [True]
    assert holds("none: «4e-15» m", 2e-12, kind="round-off") == [False]
    assert holds("none: «4e-15» m", float("nan"), kind="round-off") == [False]


def test_timings_are_told_and_never_fail():
    claim = Claim(page="README.md", text="takes «2» ms", kind="timing", run="a bench")
    (verdict,) = judged(claim, [9.0])
    assert verdict.holds
    assert "gives 9, 4.50 times that (allowed: told, never judged)" in str(verdict)


def test_a_drift_names_page_number_measurement_and_what_is_allowed():
    claim = Claim(page="README.md", text="stays for «2.35» s", kind="exact", run="a run")
    (verdict,) = judged(claim, [2.5])
    assert str(verdict) == (
        "README.md: «2.35» in “stays for 2.35 s”: a run gives 2.5 "
        "(allowed: one unit of the last digit shown)"
    )


def test_as_many_values_as_numbers():
    with pytest.raises(ValueError, match="has 1 numbers, a run gives 2"):
        holds("lasts «50.94» µs", 50.94, 1.0)


def test_numbers_are_found_in_what_a_command_prints():
    claim = Claim("p", "«1» «2»", "exact", run="r", gives=(r"^a +(\S+)%", r"b (\S+)"), scale=10.0)
    assert runs.values(claim, "b 1\na   −2.5% of b 7\n") == [-2.5, 1.0]
    with pytest.raises(ValueError, match="r prints nothing like"):
        runs.values(claim, "c 1\n")
    with pytest.raises(ValueError, match="r gives no"):
        runs.values(claim, {"c": 1.0})


@pytest.mark.parametrize(
    ("shown", "value", "last_digit"),
    [
        ("15 000", 15000.0, 1.0),
        ("150,000", 150000.0, 1.0),
        ("−1.20e-12", -1.2e-12, 1e-14),
        ("+0.31", 0.31, 0.01),
    ],
)
def test_numbers_are_read_as_they_are_written(shown, value, last_digit):
    assert Number(shown).value == value
    assert Number(shown).last_digit == pytest.approx(last_digit)


def test_numbers_of_prose_and_tables_are_seen_and_code_is_not():
    page = Page(
        "# A page 7\n\nquad4 in 3D, version 0.1.0, `x = 5`, [a link](page2.md#4), at Δt = 1.5\n"
        "ms and 10⁵ steps\n<!-- 8 -->\n```text\n9\n```\n| 2 × 20 | −1e-3 |\n"
    )
    numbers = [page.text[start:end] for start, end in page.numbers]
    assert numbers == ["7", "1.5", "10⁵", "2", "20", "−1e-3"]


def test_a_text_is_found_however_its_lines_are_broken():
    page = Page("It lasts\n  2.5 s and\n2.5 s more.\n")
    claim = Claim("p", "lasts «2.5» s", "exact")
    assert [page.text[start:end] for start, end in claim.spans(page)] == ["2.5"]


def test_a_section_ends_where_the_next_of_its_level_begins():
    page = Page("# A\n\n1\n\n## B\n\n2\n\n### C\n\n3\n\n## D\n\n4\n")
    start, end = page.section("B")
    assert page.text[start:end].split() == ["##", "B", "2", "###", "C", "3"]
    with pytest.raises(ValueError, match="0 sections"):
        page.section("E")


@pytest.fixture
def small(tmp_path, monkeypatch):
    """A page of which one number is claimed rightly, one is not, and one not at all."""
    page = tmp_path / "page.md"
    page.write_text("# A\n\nIt takes 2.5 s, or 3 ms,\nor 7.\n\n## B\n\n*History*: 9\n")
    manifest = Manifest(
        runs={"echo": {"command": "echo a 2.5 b 4"}},
        claims=[
            Claim(str(page), "takes «2.5» s", "exact", run="echo", gives=(r"a (\S+)",)),
            Claim(str(page), "or «3» ms", "count", run="echo", gives=(r"b (\S+)",)),
        ],
        sections=[Section(str(page), "B", "history", "long ago")],
        uncovered={str(page): 1},
    )
    monkeypatch.setattr(command.Manifest, "read", lambda: manifest)
    monkeypatch.setattr(command, "RECORD", tmp_path / "measured.json")
    monkeypatch.setattr("sys.argv", ["claims"])
    return manifest


def test_the_command_says_what_drifted(small, capsys, tmp_path):
    assert command.main() == 1
    said = capsys.readouterr().out
    assert "«3» in “or 3 ms”: echo gives 4 (allowed: equal)" in said
    assert "2 of 2 numbers measured, 1 drifted, 0 claims without an answer; 1 numbers" in said
    kept = json.loads((tmp_path / "measured.json").read_text())
    assert [entry["measured"] for entry in kept.values()] == [[4.0], [2.5]]


def test_the_command_lists_numbers_without_a_claim(small, capsys, monkeypatch):
    (page,) = small.pages
    monkeypatch.setattr("sys.argv", ["claims", "--bare", page])
    assert command.main() == 0
    assert capsys.readouterr().out.strip().endswith("or «7»")


def test_a_run_that_fails_is_no_confirmation(small, capsys):
    small.runs["echo"]["command"] = "false"
    assert command.main() == 1
    assert "Not measured:" in capsys.readouterr().out


def test_a_run_that_needs_what_is_not_there_is_left_out(small, capsys, monkeypatch):
    monkeypatch.delenv("CAROM_NOWHERE", raising=False)
    small.runs["echo"]["needs"] = ["CAROM_NOWHERE"]
    assert command.main() == 0
    assert "not run  echo: the environment variable CAROM_NOWHERE" in capsys.readouterr().out
