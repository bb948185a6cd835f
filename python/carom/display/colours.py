"""The colours of curves in pictures, pages and notebooks."""

from __future__ import annotations

# Okabe & Ito's palette, told apart with any colour vision.
BLUE, ORANGE, GREEN, BLACK, PURPLE = "#0072B2", "#D55E00", "#009E73", "#000000", "#CC79A7"
PALE_GREY, PALE_BLUE = "#DDDDDD", "#E3EFF8"
SKY, YELLOW, RED, BROWN, GREY = "#56B4E9", "#E0B000", "#C62839", "#8A5A2B", "#79818F"

NAMED = {
    "blue": BLUE,
    "orange": ORANGE,
    "green": GREEN,
    "purple": PURPLE,
    "sky": SKY,
    "yellow": YELLOW,
    "red": RED,
    "brown": BROWN,
    "grey": GREY,
}
"""By the names that terms of the ledger have for theirs."""

INK, FAINT = "#1B2230", "#5C6575"
"""Of text, and of text that is no more than a help."""

SOLID, SOLID_LINE = "#DDE1E8", "#8B95A5"
"""Of what is rigid: its inside and its edge."""

FORCE = "#D0305F"
"""Of arrows that are forces."""

SEQUENTIAL, DIVERGING = "YlGnBu", "RdBu_r"
"""Maps of matplotlib: for sizes, and for what has a sign."""
