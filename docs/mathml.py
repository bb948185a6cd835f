"""Formulae as MathML, which browsers typeset themselves: no script, no font and no network.

Docutils, which Sphinx stands on, has the translator from TeX; Sphinx itself offers MathJax from a
server of others, or pictures by a TeX that would have to be installed.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from typing import Any

from docutils import nodes
from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.writers.html5 import HTML5Translator

MATHML = "http://www.w3.org/1998/Math/MathML"


def mathml(formula: str, *, block: bool = False) -> str:
    """Return a formula of TeX as an element of HTML.

    Raises
    ------
    ExtensionError
        It has something that the translator does not know.
    """
    try:
        written = tex2mathml(formula, as_block=block)
    except MathError as error:
        raise ExtensionError(f"no MathML of {formula!r}: {error}") from error
    # One line: whitespace between the elements is none of the formula, but copied with it.
    element = ET.fromstring(written)
    for part in element.iter():
        part.tail = None
        part.text = part.text.strip("\n ") if part.text and part.text.strip() else None
    ET.register_namespace("", MATHML)
    return ET.tostring(element, encoding="unicode")


def _inline(self: HTML5Translator, node: nodes.math) -> None:
    self.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def _block(self: HTML5Translator, node: nodes.math_block) -> None:
    # Wide formulae scroll by themselves, by keys too.
    attributes = {"role": "region", "aria-label": "formula", "tabindex": "0"}
    self.body.append(self.starttag(node, "div", CLASS="formula", **attributes))
    self.body.append(mathml(node.astext(), block=True))
    self.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the renderer ``mathml``, to be named in ``html_math_renderer``."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
