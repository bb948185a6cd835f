"""Make the film of the README and the bands of its energy, from examples/two_cylinders.toml.

`carom run examples/two_cylinders.toml` gives the same results: no value of the case is replaced.
The film is what the commands of the README make.
"""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import carom

HERE = Path(__file__).parent
CASE = HERE.parents[1] / "examples" / "two_cylinders.toml"


def main() -> None:
    """Run the case and write the pictures beside this script."""
    with TemporaryDirectory() as scratch:
        result = carom.run(carom.Scenario.from_toml(CASE), out=Path(scratch) / "run")
        carom.film(result, HERE / "impact.webp", between=(0.0, 6.0), speed=1.0, reactions=True)
        carom.energy_flow(result).savefig(HERE / "energy-flow.png", dpi=160)


if __name__ == "__main__":
    main()
