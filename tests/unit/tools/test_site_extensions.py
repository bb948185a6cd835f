"""What the site makes of formulae and of indices in running text; it takes the extra ``docs``."""

import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

pytest.importorskip("sphinx")

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "docs"))
from mathml import MATHML, mathml  # noqa: E402 (of docs/)
from sphinx.errors import ExtensionError  # noqa: E402 (only if it is there)
from subscripts import INDEX  # noqa: E402 (of docs/)

PAGES = [page for page in (ROOT / "docs").rglob("*.md") if "decisions" not in page.parts]


def test_a_formula_is_an_element_that_needs_no_script():
    tree = ET.fromstring(mathml(r"\bar K = \frac{M}{\theta \Delta t^2}", block=True))
    assert tree.tag == f"{{{MATHML}}}math"
    assert tree.get("display") == "block"
    assert [part.tag.partition("}")[2] for part in tree] == ["mover", "mo", "mfrac"]
    assert "\n" not in mathml(r"a \qquad b")


def test_every_formula_of_the_pages_has_a_translation():
    formulae = [
        formula
        for page in PAGES
        for formula in re.findall(r"^\$\$\n(.*?)^\$\$", page.read_text("utf-8"), re.M | re.S)
    ]
    assert len(formulae) > 25
    for formula in formulae:
        assert ET.fromstring(mathml(formula, block=True)) is not None


def test_a_formula_that_is_none_ends_the_build():
    with pytest.raises(ExtensionError, match="no MathML of"):
        mathml(r"\nothing{x}")


@pytest.mark.parametrize(
    ("text", "made"),
    [
        ("F = F_e (1 + γ)", [("F", "e")]),
        ("ΔE_c + ℓ_free", [("ΔE", "c"), ("ℓ", "free")]),
        ("v_t/v_n ≥ 0", [("v", "t"), ("v", "n")]),
        ("c_pΔt = h/4", [("c", "p")]),
        ("snake_case, min_gap, D_", []),
    ],
)
def test_indices_of_symbols_are_found_and_names_are_left_alone(text, made):
    assert INDEX.findall(text) == made
