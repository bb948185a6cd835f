"""Indices in running text as indices: ``r_n`` of a page is read as r with a small n below it.

Pages are also read as text, and on GitHub, where the underscore says it. Code stays as it is.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms.post_transforms import SphinxPostTransform

GENERATED = ("case-file", "commands", "messages", "api", "api-pages/", "gallery-pages/")
"""Pages whose underscores are those of names."""

SYMBOL = r"[ΔδΣ∫∂]?[A-Za-zͰ-Ͽℓ∇][\u0300-\u036f⁺₊]*"

INDEX = re.compile(rf"(?<![A-Za-z0-9_])({SYMBOL})_([A-Za-z0-9α-ω]{{1,7}})(?![A-Za-z0-9_])")
"""A symbol of one letter, with its accents, and its index."""


class Subscripts(SphinxPostTransform):
    """Makes the indices of symbols in running text."""

    default_priority = 900
    builders = ("html", "dirhtml")

    def run(self, **_: Any) -> None:  # noqa: ANN401 (as Sphinx has it)
        """Look at the text of one page."""
        if self.env.docname.startswith(GENERATED):
            return
        closed = (nodes.literal, nodes.literal_block, nodes.math, nodes.math_block, nodes.raw)
        for text in list(self.document.findall(nodes.Text)):
            parent, parts = text.parent, INDEX.split(str(text))
            if len(parts) == 1 or isinstance(parent, closed):
                continue
            made: list[nodes.Node] = [nodes.Text(parts[0])]
            for symbol, index, after in zip(parts[1::3], parts[2::3], parts[3::3], strict=True):
                made += [nodes.Text(symbol), nodes.subscript("", index), nodes.Text(after)]
            parent.replace(text, [node for node in made if node.astext()])


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the transform."""
    app.add_post_transform(Subscripts)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
