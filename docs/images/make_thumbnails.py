"""Make the thumbnails of the README and of the site: bodies and colours, and nothing else.

``python docs/images/make_thumbnails.py [NAME …]`` runs each case into results/thumbnails, unless
its results are there, and draws one instant of it. The bracket and the Taylor bar take minutes,
others seconds.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

import carom
from carom.new.template import template

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "results" / "thumbnails"
sys.path[:0] = [str(ROOT / "examples")]

SIZE = (480, 360)
"""Of a thumbnail [px]."""

Run = Callable[[Path], None]


def case(name: str) -> Run:
    """Return what runs a case of examples/."""

    def run(out: Path) -> None:
        carom.run(carom.Scenario.from_toml(ROOT / "examples" / f"{name}.toml"), out=out)

    return run


def hertz(out: Path) -> None:
    """Run the template static-hertz."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "static-hertz.toml"
        file.write_text(template("static-hertz"), encoding="utf-8")
        carom.run(carom.Scenario.from_toml(file), out=out)


def bracket(out: Path) -> None:
    """Drop the bracket on the coarse mesh of the gallery, in some minutes."""
    import gmsh_part  # noqa: PLC0415 (of examples/)

    mesh = ROOT / "docs" / "gallery" / "bracket.msh"
    method = ["analysis.scheme={kind='conserving'}", "contact.condition='midpoint'"]
    scenario = gmsh_part.scenario(mesh, end_time=1.6e-4)
    carom.run(scenario.with_overrides(method), out=out)


def arch(out: Path) -> None:
    """Let the thin arch fall."""
    import masonry_arch  # noqa: PLC0415 (of examples/)

    with TemporaryDirectory() as folder:
        carom.run(masonry_arch.scenario(Path(folder), 0.08, 0.5), out=out)


CASES: dict[str, tuple[Run, dict[str, Any]]] = {
    "ring": (case("thrown_ring"), {"times": 0.105, "field": "von-mises", "limits": (0.0, 6e5)}),
    "bracket": (
        bracket,
        {"times": 1.4e-4, "field": "von-mises", "smooth": True, "camera": (-50.0, 28.0)},
    ),
    "taylor": (case("taylor_bar"), {"times": 4.4e-5, "field": "plastic_strain"}),
    "hertz": (
        hertz,
        {
            "field": "von-mises",
            "magnification": 40.0,
            "smooth": True,
            "edges": False,
            "window": (0.0, -0.04, 0.06, 0.005),
        },
    ),
    "arch": (arch, {"times": 0.36, "field": "body", "camera": (-65.0, 14.0)}),
    "pile": (case("pile"), {"field": "von-mises"}),
    "press-fit": (case("press_fit"), {"field": "von-mises", "edges": False}),
}


def scikit_fem() -> Figure:
    """Draw the discs of scikit-fem while they press each other."""
    import scikit_fem_discs as example  # noqa: PLC0415 (of examples/)

    discs = example.Discs()
    positions: list[np.ndarray] = []
    energy = discs.strain_energy

    def noting(u: np.ndarray) -> float:
        positions.append(discs.mesh.p.T + u[discs.basis.nodal_dofs.T])
        return float(energy(u))

    discs.strain_energy = noting
    run = example.collide(discs, end_time=0.2)
    hardest = int(np.argmax(run.strain))
    figure = Figure(figsize=(4.8, 3.6))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    where, cells = positions[hardest], discs.mesh.t.T
    left = cells[:, 0] < discs.nodes
    for own, colour in ((left, "#8FB8DE"), (~left, "#F2B98A")):
        shown = np.where(own, 1.0, 0.0)
        axes.tripcolor(
            *where.T, cells[own], shown[own], cmap=None, edgecolors="#1B2230", linewidth=0.5
        ).set(facecolor=colour, array=None)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.margins(0.04)
    return figure


def thumbnail(figure: Figure, file: Path) -> None:
    """Write a picture into the middle of a sheet of the size of thumbnails."""
    drawn = BytesIO()
    figure.savefig(drawn, format="png", dpi=300)
    picture = Image.open(drawn).convert("RGB")
    picture.thumbnail(SIZE, Image.Resampling.LANCZOS)
    sheet = Image.new("RGB", SIZE, "white")
    sheet.paste(picture, tuple((a - b) // 2 for a, b in zip(SIZE, picture.size, strict=True)))
    sheet.quantize(128, dither=Image.Dither.NONE).save(file, optimize=True)


def main(names: list[str]) -> None:
    """Make the thumbnails of these names, or all."""
    for name in names or [*CASES, "scikit-fem"]:
        file = HERE / f"thumbnail-{name}.png"
        if name == "scikit-fem":
            thumbnail(scikit_fem(), file)
            continue
        run, look = CASES[name]
        results = RESULTS / name
        if not (results / "history.csv").exists():
            run(results)
        thumbnail(carom.picture(results, bare=True, width=120.0, **look), file)
        print(file)


if __name__ == "__main__":
    main(sys.argv[1:])
