"""The page of the documentation that lists what carom says when something is wrong."""

import importlib
import re
import sys
from pathlib import Path

import pytest
from test_messages import BAD, spoil

import carom
import heard
from carom.messages import DATA_MESSAGES

DOCS = Path(__file__).parents[3] / "docs"


@pytest.fixture(scope="module")
def pages():
    sys.path.insert(0, str(DOCS))
    try:
        return importlib.import_module("make_messages")
    finally:
        sys.path.remove(str(DOCS))


@pytest.fixture(scope="module")
def listed(pages):
    """Patterns of the messages on the page: any text may stand where a value is put in."""
    lines = re.findall(r"(?m)^- `(.*)`$", pages.PAGE.read_text(encoding="utf-8"))
    return [re.compile(".*".join(map(re.escape, re.split(r"\{[^{}]*\}", line)))) for line in lines]


def test_the_page_lists_every_message_of_the_sources(pages):
    assert pages.PAGE.read_text(encoding="utf-8") == pages.page()


def test_every_section_has_messages_a_cause_and_a_cure(pages):
    sections = pages.PAGE.read_text(encoding="utf-8").split("\n## ")[1:]
    assert len(sections) == len(pages.areas())
    for section in sections:
        assert re.search(r"\*\*Cause\.\*\* \w.*\n\n\*\*Cure\.\*\* \w.*\n\n- `", section), section


@pytest.mark.parametrize(("path", "value"), [(path, value) for path, value, _ in BAD])
def test_what_bad_input_is_told_is_on_the_page(box, listed, path, value):
    spoil(box, path, value)
    with pytest.raises(carom.InputError) as caught:
        carom.Scenario.from_dict(box)
    said = str(caught.value).removeprefix(f"{caught.value.key}")
    said = said.split(": ", 1)[1]
    pure = [p for p in listed if re.sub(r"\W|\.\*", "", p.pattern)]
    assert any(p.fullmatch(said) for p in pure), said


def test_a_message_that_nothing_provokes_is_named():
    listed = heard.listed()
    silent = "the moon is {…} m from body {…}"
    assert f"provoke this in a test: {silent}" in heard.faults(listed, listed | {silent})
    assert not any(silent in fault for fault in heard.faults(listed, listed))


def test_words_count_for_the_longest_message_that_fits():
    listed = [
        "must be {expected}",
        "must be a number",
        "{…} of {…} nodes",
        "no cell {…} of {…} nodes",
    ]
    assert heard.met(listed, ["a.b = 1: must be a number"]) == {"must be a number"}
    assert heard.met(listed, ["x: must be one of 'a', 'b'"]) == {"must be {expected}"}
    assert heard.met(listed, ["no cell tri3 of 4 nodes"]) == {"no cell {…} of {…} nodes"}
    both = "must be a number, and no cell tri3 of 4 nodes"
    assert heard.met(listed, [both]) == {"must be a number", "no cell {…} of {…} nodes"}


def test_a_message_that_nobody_lists_is_found(tmp_path, pages):
    source = tmp_path / "python/carom/new.py"
    source.parent.mkdir(parents=True)
    source.write_text('def f(x):\n    raise InputError(f"{x}: is quite a new thing; leave it")\n')
    core = tmp_path / "crates/new/src/lib.rs"
    core.parent.mkdir(parents=True)
    core.write_text(
        'fn f() { assert!(true, "not for users to see");\n'
        '    Err(format!("{x} is another \\\n        new thing")) }\n'
        '#[cfg(test)] mod tests { const A: &str = "only in a test"; }\n'
    )
    assert importlib.import_module("message_texts").texts(tmp_path) == {
        "crates/new/src/lib.rs": ["{…} is another new thing"],
        "python/carom/new.py": ["{…}: is quite a new thing; leave it"],
    }


def test_the_wording_of_wrong_types_is_on_the_page(pages):
    page = pages.PAGE.read_text(encoding="utf-8")
    said = [text for text in DATA_MESSAGES.values() if text != "{error}"]
    assert all(f"- `{text}`" in page for text in said)
