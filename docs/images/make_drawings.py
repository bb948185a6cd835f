"""Draw a step, a contact and the ledger as SVG: ``python docs/images/make_drawings.py [--check]``.

Each drawing has a ground of its own, so that it can be read on light and on dark pages.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from html import escape
from pathlib import Path

HERE = Path(__file__).resolve().parent

INK, SOFT, GROUND, LINE = "#1B2230", "#4A5468", "#FFFFFF", "#8A94A6"
BLUE, ORANGE, GREEN, GREY = "#0B5FA5", "#B4500A", "#1E7B4F", "#DDE3EC"
PALE_BLUE, PALE_ORANGE, PALE_GREEN = "#DCEBF9", "#FBE6D5", "#DDF1E6"
FONT = "system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif"

Point = tuple[float, float]


class Drawing:
    """What is drawn, in pixels from the upper left corner.

    Parameters
    ----------
    width, height
        Size of the drawing [px].
    title
        What it shows, for those who do not see it.
    """

    def __init__(self, width: int, height: int, title: str) -> None:
        self._width, self._height, self._title = width, height, title
        self._parts: list[str] = []

    def box(self, at: Point, size: Point, fill: str, stroke: str = LINE) -> None:
        """Draw a rectangle with round corners."""
        self._parts.append(
            f'<rect x="{at[0]:g}" y="{at[1]:g}" width="{size[0]:g}" height="{size[1]:g}" rx="7" '
            f'fill="{fill}" stroke="{stroke}" stroke-width="1.5"/>'
        )

    def polygon(self, points: Sequence[Point], fill: str, opacity: float = 1.0) -> None:
        """Fill a polygon."""
        self._parts.append(
            f'<polygon points="{_places(points)}" fill="{fill}" fill-opacity="{opacity:g}"/>'
        )

    def line(
        self,
        points: Sequence[Point],
        colour: str = INK,
        *,
        width: float = 2.0,
        arrow: bool = False,
        dashed: bool = False,
    ) -> None:
        """Draw a line through points, with a head at its end where it is an arrow."""
        dash = ' stroke-dasharray="5 4"' if dashed else ""
        self._parts.append(
            f'<polyline points="{_places(points)}" fill="none" stroke="{colour}" '
            f'stroke-width="{width:g}" stroke-linejoin="round"{dash}/>'
        )
        if arrow:
            (x0, y0), (x1, y1) = points[-2:]
            angle = math.atan2(y1 - y0, x1 - x0)
            wings = [
                (x1 - 10 * math.cos(angle + turn), y1 - 10 * math.sin(angle + turn))
                for turn in (-0.45, 0.45)
            ]
            self.polygon([(x1, y1), *wings], colour)

    def dot(self, at: Point, colour: str = INK, radius: float = 5.0) -> None:
        """Draw a node."""
        self._parts.append(
            f'<circle cx="{at[0]:g}" cy="{at[1]:g}" r="{radius:g}" fill="{colour}"/>'
        )

    def text(
        self,
        at: Point,
        lines: str | Sequence[str],
        *,
        size: float = 15.0,
        colour: str = INK,
        anchor: str = "middle",
        bold: bool = False,
        italic: bool = False,
    ) -> None:
        """Write lines, the first of them at a place."""
        style = (' font-weight="600"' if bold else "") + (' font-style="italic"' if italic else "")
        for number, line in enumerate([lines] if isinstance(lines, str) else lines):
            self._parts.append(
                f'<text x="{at[0]:g}" y="{at[1] + 1.3 * size * number:g}" font-size="{size:g}" '
                f'fill="{colour}" text-anchor="{anchor}"{style}>{escape(line)}</text>'
            )

    def svg(self) -> str:
        """Return the file."""
        inside = "\n".join(self._parts)
        return (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self._width} {self._height}" '
            f'width="{self._width}" height="{self._height}" role="img" font-family="{FONT}">\n'
            f"<title>{escape(self._title)}</title>\n"
            f'<rect width="{self._width}" height="{self._height}" rx="12" fill="{GROUND}"/>\n'
            f"{inside}\n</svg>\n"
        )


def _places(points: Sequence[Point]) -> str:
    return " ".join(f"{x:g},{y:g}" for x, y in points)


def step() -> Drawing:
    """Draw how a time step goes."""
    page = Drawing(
        900,
        330,
        "A step: predict, search, iterate, check, commit; a step that fails is taken in halves",
    )
    top, height = 70.0, 118.0
    stages = [
        (24.0, 118.0, "predict", ["where bodies", "would fly", "by themselves"], GREY),
        (170.0, 118.0, "search", ["which nodes", "and facets", "may meet"], GREY),
        (610.0, 118.0, "check", ["is anything", "else in", "the way?"], GREY),
        (756.0, 120.0, "commit", ["velocities,", "books and", "certificate"], PALE_GREEN),
    ]
    for left, width, name, said, fill in stages:
        page.box((left, top), (width, height), fill)
        page.text((left + width / 2, top + 28), name, size=17, bold=True)
        page.text((left + width / 2, top + 56), said, size=13, colour=SOFT)
    page.box((316, top - 44), (266, height + 84), PALE_BLUE, BLUE)
    page.text((449, top - 20), "iterate", size=17, bold=True, colour=BLUE)
    inner = [
        ("bodies", "forces and tangents, each by itself"),
        ("contacts", "W = H K̄⁻¹ Hᵀ: how they give way"),
        ("laws", "reactions r that obey them exactly"),
        ("bodies", "move by what r does to them"),
    ]
    for number, (name, said) in enumerate(inner):
        place = top + 8 + 34 * number
        page.text((330, place), name, size=13.5, anchor="start", bold=True)
        page.text((330, place + 15), said, size=12.5, anchor="start", colour=SOFT)
    page.text((449, top + height + 28), "until corrections are small", size=12.5, colour=BLUE)
    middle = top + height / 2
    for start, end in ((142, 170), (288, 316), (582, 610), (728, 756)):
        page.line([(start, middle), (end, middle)], arrow=True)
    below = top + height + 40
    page.line([(669, top + height), (669, below + 26), (500, below + 26), (500, below)], arrow=True)
    page.text((680, below + 22), "yes: one contact more", size=13.5, colour=SOFT, anchor="start")
    page.line(
        [(398, below), (398, below + 58), (83, below + 58), (83, top + height)],
        ORANGE,
        arrow=True,
        dashed=True,
    )
    said = "no end: the step is undone and taken in two halves"
    page.text((240, below + 78), said, size=13.5, colour=ORANGE)
    return page


def contact() -> Drawing:
    """Draw a node before a facet, and what its reaction may be."""
    page = Drawing(
        900,
        360,
        "A contact: a node at a gap before a facet, its normal and tangent; and three states, "
        "separation, stick and slip, with the reaction in the cone of friction",
    )
    left, right, height = (50.0, 262.0), (430.0, 222.0), 84.0
    page.polygon([left, right, (430, 336), (50, 336)], PALE_BLUE)
    page.line([left, right], BLUE, width=3)
    for at in (left, right):
        page.dot(at, BLUE)
    page.text((240, 312), "target: a facet between its nodes", size=14, colour=BLUE)
    share = 0.52
    foot = (left[0] + share * (right[0] - left[0]), left[1] + share * (right[1] - left[1]))
    angle = math.atan2(right[1] - left[1], right[0] - left[0])
    normal = (math.sin(angle), -math.cos(angle))
    tangent = (math.cos(angle), math.sin(angle))
    node = (foot[0] + height * normal[0], foot[1] + height * normal[1])
    page.polygon(
        [node, (node[0] - 96, node[1] - 62), (node[0] - 20, 34), (node[0] + 86, node[1] - 78)],
        PALE_ORANGE,
    )
    page.line([(node[0] - 96, node[1] - 62), node, (node[0] + 86, node[1] - 78)], ORANGE, width=3)
    page.dot(node, ORANGE)
    page.text((node[0] - 6, node[1] - 62), "source: a node", size=14, colour=ORANGE)
    page.line([foot, node], SOFT, width=1.5, dashed=True)
    page.text((node[0] - 18, 0.5 * (foot[1] + node[1]) + 4), "g", size=17, italic=True)
    page.dot(foot, INK, 3.5)
    for direction, name in ((normal, "n"), (tangent, "t")):
        tip = (foot[0] + 58 * direction[0], foot[1] + 58 * direction[1])
        start = (foot[0] + 3 * direction[0], foot[1] + 3 * direction[1])
        page.line([start, tip], arrow=True)
        beside = (tip[0] + 14, tip[1] + (4 if name == "n" else 20))
        page.text(beside, name, size=17, italic=True)
    states = [
        ("separation", "g > 0", "no force", None, 0.0),
        ("stick", "g = 0, no slip", "r in the cone", 0.35, 0.0),
        ("slip", "g = 0, slip w", "r on its edge", 1.0, 58.0),
    ]
    half, tall = 44.0, 120.0
    for number, (name, where, force, across, slip) in enumerate(states):
        middle, ground = 540.0 + 140.0 * number, 232.0
        page.text((middle, 56), name, size=17, bold=True)
        page.polygon(
            [(middle, ground), (middle - half, ground - tall), (middle + half, ground - tall)],
            PALE_GREEN,
        )
        page.line([(middle - 58, ground), (middle + 58, ground)], BLUE, width=3)
        lift = 16.0 if across is None else 0.0
        page.dot((middle, ground - lift), ORANGE)
        if across is not None:
            tip = (middle - across * half * 0.8, ground - tall * 0.8)
            page.line([(middle, ground), tip], GREEN, width=3, arrow=True)
            page.text((tip[0] - 12, tip[1] - 4), "r", size=16, italic=True, colour=GREEN)
        if slip:
            page.line([(middle, ground + 12), (middle + slip, ground + 12)], ORANGE, arrow=True)
        page.text((middle, ground + 42), [where, force], size=14, colour=SOFT)
    page.text(
        (680, 324), "the cone is as wide as the coefficient of friction: |rₜ| ≤ μ rₙ", size=14
    )
    return page


def ledger() -> Drawing:
    """Draw the books as a balance of bars."""
    page = Drawing(
        900,
        340,
        "The ledger: what a run had and received stands against what it has and lost; what is left "
        "over is the defect",
    )
    floor, width = 276.0, 150.0
    columns: list[tuple[float, str, list[tuple[float, str, str, str]]]] = [
        (
            70.0,
            "had and received",
            [
                (66, PALE_BLUE, "kinetic", "of what moved"),
                (44, PALE_ORANGE, "strain", "of what was bent"),
                (56, GREY, "external", "loads, gravity"),
                (44, GREY, "prescribed", "walls that are driven"),
            ],
        ),
        (
            520.0,
            "has and lost",
            [
                (52, PALE_BLUE, "kinetic", "of what moves"),
                (38, PALE_ORANGE, "strain", "of what is bent"),
                (42, PALE_GREEN, "friction", "at what slides"),
                (30, PALE_GREEN, "viscous, plastic", "inside the bodies"),
                (26, PALE_GREEN, "contact, scheme", "of the method, told apart"),
            ],
        ),
    ]
    tops = []
    for left, title, parts in columns:
        place = floor
        for height, fill, name, said in parts:
            place -= height
            page.box((left, place), (width, height), fill)
            page.text((left + width / 2, place + height / 2 + 5), name, size=14.5, bold=True)
            page.text(
                (left + width + 14, place + height / 2 + 5),
                said,
                size=13.5,
                colour=SOFT,
                anchor="start",
            )
        page.text((left + width / 2, floor + 30), title, size=16, bold=True)
        tops.append(place)
    page.line([(50, floor), (850, floor)], INK)
    page.line([(70, tops[0]), (520, tops[0])], ORANGE, width=1.5, dashed=True)
    page.line([(430, tops[1]), (520, tops[1])], ORANGE, width=1.5, dashed=True)
    page.line([(470, tops[0] - 20), (470, tops[0])], ORANGE, arrow=True)
    page.line([(470, tops[1] + 20), (470, tops[1])], ORANGE, arrow=True)
    page.text((470, tops[0] - 28), "defect", size=16, bold=True, colour=ORANGE)
    page.text(
        (450, 326),
        "Each term is computed from its own definition, none as the rest: the defect is measured.",
        size=14,
    )
    return page


DRAWINGS: dict[str, Callable[[], Drawing]] = {"step": step, "contact": contact, "ledger": ledger}


def main(arguments: list[str]) -> int:
    """Write the drawings, or say which are not as this script draws them."""
    stale = 0
    for name, draw in DRAWINGS.items():
        file, text = HERE / f"drawing-{name}.svg", draw().svg()
        if "--check" not in arguments:
            file.write_text(text, encoding="utf-8")
        elif not file.is_file() or file.read_text(encoding="utf-8") != text:
            print(f"{file} is not what {Path(__file__).name} draws")
            stale = 1
    return stale


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
