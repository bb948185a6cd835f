"""Make the font of the formulae: ``python docs/make_math_font.py STIXTwoMath-Regular.ttf``.

Browsers lay formulae out by the table MATH of a font, which many machines have no font with. STIX
Two Math is under the SIL Open Font License 1.1; its notices stay in the file. The wheel ziamath
0.13 of PyPI has the font whose digest stands below. What no page of ours needs is left out.
"""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path

from fontTools import subset

DIGEST = "8f42cb183a85043a4dc3f8e41ac3821eb27bf178d68ace929ba439523622323c"
"""SHA-256 of the font that is taken."""

CHARACTERS = [
    (0x20, 0x7E),  # Latin
    (0xA0, 0xFF),
    (0x2C6, 0x2DD),  # accents
    (0x300, 0x338),
    (0x391, 0x3F6),  # Greek
    (0x2010, 0x2057),  # dashes, primes
    (0x20D0, 0x20EF),
    (0x2190, 0x21D5),  # arrows
    (0x2200, 0x22FF),  # operators
    (0x2308, 0x230B),  # brackets
    (0x2016, 0x2016),
    (0x27E8, 0x27E9),
    (0x210E, 0x210E),
    (0x211D, 0x211D),  # the real numbers
    (0x1D434, 0x1D467),  # italics, Latin and Greek
    (0x1D6E2, 0x1D71B),
]
"""First and last of the ranges that are kept."""


def main(arguments: list[str]) -> None:
    """Run the script."""
    source = Path(arguments[0])
    if hashlib.sha256(source.read_bytes()).hexdigest() != DIGEST:
        raise SystemExit(f"{source} is not the font that was looked at")
    options = subset.Options(flavor="woff", layout_features=["ssty", "dtls", "mark", "mkmk"])
    options.name_IDs = [0, 1, 2, 3, 4, 5, 6, 13, 14]
    font = subset.load_font(str(source), options)
    maker = subset.Subsetter(options)
    maker.populate(unicodes=[c for first, last in CHARACTERS for c in range(first, last + 1)])
    maker.subset(font)
    subset.save_font(font, str(Path(__file__).parent / "static/stix-two-math.woff"), options)


if __name__ == "__main__":
    main(sys.argv[1:])
