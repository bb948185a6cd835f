"""Make the film of the README from a run of examples/two_cylinders.toml as it is.

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
    """Run the case and write the film beside this script."""
    with TemporaryDirectory() as scratch:
        result = carom.run(carom.Scenario.from_toml(CASE), out=Path(scratch) / "run")
        carom.film(result, HERE / "impact.webp", between=(0.0, 6.0), speed=1.0, reactions=True)


if __name__ == "__main__":
    main()
