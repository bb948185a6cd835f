"""The scene of a run for the output of a cell: one element that holds a page of its own.

Scripts and libraries are deflated, so that an output is a third of a megabyte and a notebook stays
one that can be mailed. The page is in a frame without rights: it sees nothing of the notebook.
"""

from __future__ import annotations

import base64
import zlib
from functools import cache
from pathlib import Path
from string import Template

from carom import __version__
from carom.display.markup import Html, element, embedded, join
from carom.errors import InputError
from carom.io import layout
from carom.report.assembly import asset, elements, policy
from carom.report.scene import scene_data, shown_bodies
from carom.report.source import read_source

SCRIPTS = (
    "codec.js",
    "theme.js",
    "clock.js",
    "format.js",
    "colours.js",
    "shapes.js",
    "connections.js",
    "scene.js",
    "colour_bar.js",
    "stage.js",
    "transport.js",
    "notebook.js",
)
"""Of the scene, in the order in which they need one another."""

BUDGET = 150_000
"""Characters that the fields may take in the output of a cell, unless the bodies are larger."""

MOST_FIELDS = 3
"""Fields to choose colours from: the stress, and what comes next in the list of the report."""

LARGEST_FILE = 50_000_000
"""Bytes of fields beyond which the scene is left to the report: notebooks show results at once."""

HEIGHT = 520
"""Of the frame [px]."""


def notebook_scene(directory: Path) -> Html | None:
    """Return the scene of a run as one element, None where there is nothing to draw.

    Parameters
    ----------
    directory
        The results directory.
    """
    fields = directory / layout.FIELDS
    if not fields.is_file() or fields.stat().st_size > LARGEST_FILE:
        return None
    try:
        source = read_source(directory)
    except (InputError, OSError):
        return None
    notes: list[str] = []
    shown = shown_bodies(source, notes, budget=BUDGET, most_fields=MOST_FIELDS)
    if shown is None:
        return None
    loader = asset("assets", "unpack.js")
    text = Template(asset("assets", "notebook.html")).substitute(
        version=join(__version__),
        policy=join(policy([loader], unpacked=True)),
        title=join(source.title),
        style=asset("assets", "style.css"),
        scene=asset("assets", "scene.html"),
        transport=asset("assets", "transport.html"),
        data=embedded(scene_data(source, shown, notes), id="data"),
        code=_code(),
        scripts=join(*elements([loader])),
    )
    return element(
        "iframe",
        srcdoc=text,
        sandbox="allow-scripts",
        loading="lazy",
        title=f"{source.title}: the bodies in motion",
        style=f"width: 100%; height: {HEIGHT}px; border: 0; display: block",
    )


@cache
def _code() -> str:
    """Return library and scripts in one piece, deflated, in base64."""
    licence = f"/*\n{asset('vendor', 'LICENSE-three')}\n*/"
    own = "\n".join(asset("assets", name) for name in SCRIPTS)
    code = "\n".join([licence, asset("vendor", "three.min.js"), own])
    return base64.b64encode(zlib.compress(code.encode(), 9)).decode()
