"""Every number of the documentation is in benchmarks/claims.toml, with what measures it."""

import re

import pytest
from claims import measures, runs
from claims.judge import judged
from claims.manifest import MEASURED, TOLD, Manifest
from claims.pages import ROOT, Page

MANIFEST = Manifest.read()
PAGES = {name: Page.read(name) for name in MANIFEST.pages}


def shown(claim):
    return f"{claim.page}: {claim.plain}"


def test_what_is_claimed_stands_on_its_page():
    """Symptom guarded against: a page and what was measured went separate ways."""
    absent = [shown(c) for c in MANIFEST.claims if not PAGES[c.page].places(c.plain)]
    assert absent == []


@pytest.mark.parametrize("page", MANIFEST.pages)
def test_a_number_of_a_page_has_a_claim(page):
    """Numbers without one may only become fewer: claims.toml says how many there are."""
    bare = MANIFEST.bare(page)
    assert len(bare) == MANIFEST.uncovered[page], bare


def test_the_readme_has_no_number_without_a_claim():
    assert MANIFEST.uncovered["README.md"] == 0


def test_numbers_that_are_summed_up_agree_with_the_tables_they_are_from():
    """Symptom guarded against: README said 4e-15, docs/validation.md 9.9e-15."""
    quick = {name: runs.measure(run) for name, run in MANIFEST.runs.items() if run.get("quick")}
    verdicts = [
        verdict
        for claim in MANIFEST.claims
        if claim.run in quick
        for verdict in judged(claim, runs.values(claim, quick[claim.run]))
    ]
    assert len(verdicts) > 30
    assert [str(verdict) for verdict in verdicts if not verdict.holds] == []


def test_a_claim_has_a_run_or_a_reason():
    for claim in MANIFEST.claims:
        assert claim.numbers, shown(claim)
        if claim.run is None:
            assert claim.kind in TOLD and claim.reason, shown(claim)
        else:
            assert claim.kind in MEASURED and claim.run in MANIFEST.runs, shown(claim)


def test_what_finds_numbers_finds_as_many_as_are_claimed():
    for claim in MANIFEST.claims:
        if claim.run is None:
            continue
        if "python" in MANIFEST.runs[claim.run]:
            found = len(claim.gives)
        else:
            found = sum(re.compile(each).groups for each in claim.gives)
        assert found == len(claim.numbers), shown(claim)


def test_runs_are_of_what_there_is():
    for name, run in MANIFEST.runs.items():
        if "python" in run:
            assert callable(getattr(measures, run["python"])), name
        elif "page" in run or "blocks" in run:
            assert (ROOT / run.get("page", run.get("blocks"))).exists(), name
        else:
            scripts = re.findall(r"(?:examples|benchmarks)/\w+\.py", run["command"])
            assert all((ROOT / script).exists() for script in scripts), name
            for target in re.findall(r"--bench (\w+)", run["command"]):
                assert (ROOT / "crates/carom/benches" / f"{target}.rs").exists(), name


def test_history_says_so_on_the_page():
    """What cannot be measured again is no promise, and readers see that."""
    for section in MANIFEST.sections:
        start, end = PAGES[section.page].section(section.heading)
        assert section.reason
        if section.kind == "history":
            assert "*History*" in PAGES[section.page].text[start:end], section.heading
    for claim in MANIFEST.claims:
        if claim.kind == "history":
            assert "history*" in PAGES[claim.page].text.lower(), shown(claim)
