"""Options that pictures, films and the window have in common."""

from __future__ import annotations

from typing import Annotated

import typer

from carom.errors import InputError
from carom.view.camera import AZIMUTH, ELEVATION

FieldName = Annotated[
    str | None,
    typer.Option(
        "--field",
        metavar="NAME",
        help="What gives the colours: von-mises, hydrostatic-pressure, displacement, velocity, "
        "reaction, strain, plastic_strain, energy_density; on boundaries pressure, slip, "
        "friction_energy; body tells bodies apart. Default: the most telling that there is.",
    ),
]

Limits = Annotated[
    tuple[float, float] | None,
    typer.Option(
        "--range",
        metavar="LOW HIGH",
        help="Values of the first and the last colour. Default: those that are shown.",
    ),
]

Smooth = Annotated[
    bool,
    typer.Option(
        "--smooth",
        help="Let what is known per cell run on, as the mean of the cells around each node.",
    ),
]

Edges = Annotated[bool, typer.Option("--edges/--no-edges", help="Draw the edges of cells.")]

Reactions = Annotated[bool, typer.Option("--reactions", help="Draw the contact reactions.")]

Magnification = Annotated[
    float, typer.Option(metavar="M", help="What displacements are multiplied by.")
]

Colours = Annotated[
    str | None,
    typer.Option(metavar="MAP", help="A colour map of matplotlib, such as viridis or magma_r."),
]

Camera = Annotated[
    tuple[float, float],
    typer.Option(
        metavar="AZIMUTH ELEVATION",
        help="Where bodies in space are seen from: around z from the x axis, and above [degrees].",
    ),
]

FROM_THE_FRONT = (AZIMUTH, ELEVATION)

Window = Annotated[
    tuple[float, float, float, float] | None,
    typer.Option(
        metavar="LEFT BOTTOM RIGHT TOP",
        help="What is seen of the plane [m]. Default: the bodies.",
    ),
]


def numbers(option: str, text: str) -> list[float]:
    """Read numbers with commas between them.

    Raises
    ------
    InputError
        The text is something else.
    """
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise InputError(
            f"{option} {text}: give a number, or several with commas between them"
        ) from None


def pixels(text: str | None) -> tuple[int, int] | None:
    """Read the size of a film, such as ``1280x720``.

    Raises
    ------
    InputError
        The text is something else.
    """
    if text is None:
        return None
    width, _, height = text.lower().partition("x")
    try:
        return int(width), int(height)
    except ValueError:
        raise InputError(
            f"--size {text}: give width and height in pixels, such as 1280x720"
        ) from None
