"""Springs, dampers and point masses on the page: in the scene as plain data, and as tables."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.case.scenario import Scenario
from carom.case.spring import Spring
from carom.display.markup import Html, element, format_number, join
from carom.io.frames import Frames
from carom.report.codec import pack, pack_quantised
from carom.report.source import Columns, Source
from carom.view.coils import WIDTH, shapes
from carom.view.connections import Connections, connections, label


def attached(
    scenario: Scenario, frames: Frames, taken: NDArray[np.int64], notes: list[str]
) -> tuple[Connections, NDArray[np.float64]]:
    """Return what is attached to the bodies, and how far it has moved in the frames that are taken.

    Parameters
    ----------
    scenario
        The case.
    frames
        The file with the bodies.
    taken
        Numbers of frames.
    notes
        What is not drawn is added here.

    Returns
    -------
    tuple
        The places, and how far they have moved [m], shape [taken_count, place_count, D].
    """
    found = connections(scenario, frames)
    notes += found.missing
    moved = [found.moved(int(frame)) for frame in taken]
    return found, np.array(moved).reshape(len(taken), len(found.places), found.dimension)


def attached_data(
    found: Connections,
    moved: NDArray[np.float64],
    *,
    history: Columns,
    taken: NDArray[np.int64],
    size: float,
) -> dict[str, Any] | None:
    """Return springs and point masses as plain data for JSON; None if there are none.

    Parameters
    ----------
    found, moved
        As of `attached`.
    history
        Columns by title, for the forces.
    taken
        Numbers of frames.
    size
        Diagonal of the box around what is seen [m].
    """
    if not found:
        return None
    made = shapes(found, size)
    pieces = np.concatenate(made) if made else np.empty((0, 2, 3))
    return {
        "links": [
            {
                "name": link.name,
                "kind": link.kind,
                "between": [end.label for end in link.ends],
                "free_length": link.free_length,
                "pieces": len(shape),
            }
            for link, shape in zip(found.links, made, strict=True)
        ],
        "lumps": [{"mass": lump.mass, "of": lump.place.label} for lump in found.lumps],
        "width": WIDTH * size,
        "arrays": {
            "pieces": pack(pieces, "f4"),
            "drawn": pack(found.drawn, "f8"),
            "moved": pack_quantised(moved),
            "force": pack(found.forces(history, taken.tolist()), "f8"),
        },
    }


def spring_table(source: Source) -> Html | None:
    """Return of every spring between what it is, how long it was, and how it pulled and pushed."""
    springs = source.scenario.springs if source.scenario else ()
    shown = [spring for spring in springs if len(source.history.get(f"{spring.name}.length", ()))]
    if not shown:
        return None
    titles = ("shortest [m]", "longest [m]", "pulled up to [N]", "pushed up to [N]")
    head = element(
        "tr",
        element("th", "spring", scope="col"),
        element("th", "between", scope="col"),
        *(element("th", title, scope="col", class_="number") for title in titles),
    )
    rows = [_spring_row(spring, source.history) for spring in shown]
    return element("table", element("thead", head), element("tbody", *rows))


def _spring_row(spring: Spring, history: Columns) -> Html:
    length, force = (history[f"{spring.name}.{what}"] for what in ("length", "force"))
    pull, push = np.maximum(force, 0.0).max(), np.maximum(-force, 0.0).max()
    values = (length.min(), length.max(), pull, abs(push))
    ends = " – ".join(label(end) for end in spring.between)
    return element(
        "tr",
        element("th", spring.name, scope="row"),
        element("td", ends),
        *(element("td", join(format_number(float(v), 4)), class_="number") for v in values),
    )


def mass_table(source: Source) -> Html | None:
    """Return the point masses, and what they are on."""
    masses = source.scenario.masses if source.scenario else ()
    if not masses:
        return None
    head = element(
        "tr",
        element("th", "on", scope="col"),
        element("th", "mass [kg]", scope="col", class_="number"),
    )
    rows = [
        element(
            "tr",
            element("th", label(mass), scope="row"),
            element("td", format_number(mass.mass), class_="number"),
        )
        for mass in masses
    ]
    return element("table", element("thead", head), element("tbody", *rows))
