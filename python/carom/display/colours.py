"""The colours of curves in pictures, pages and notebooks."""

from __future__ import annotations

# Okabe & Ito's palette, told apart with any colour vision.
BLUE, ORANGE, GREEN, BLACK, PURPLE = "#0072B2", "#D55E00", "#009E73", "#000000", "#CC79A7"
PALE_GREY, PALE_BLUE = "#DDDDDD", "#E3EFF8"
