"""
A seal: rubber that keeps its volume is squeezed
================================================

A rubber cord is squeezed between two plates by a fifth of its height, as an O-ring in its groove.
Rubber keeps its volume, so it must go sideways, and its force grows faster than the way. This is
the template ``seal`` of ``carom new``.
"""

from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
from pictures import draw

import carom
from carom.new.template import template

case = Path(mkdtemp()) / "seal.toml"
case.write_text(template("seal"), encoding="utf-8")
scenario = carom.Scenario.from_toml(case)
result = carom.run(scenario, out=mkdtemp())

# %%
# How well the volume is kept: the area of the cord, from the corners of its cells.


def area(points: np.ndarray, cells: np.ndarray) -> float:
    """Return the area of quadrilaterals [m²]."""
    x, y = points[cells][..., :2].transpose(2, 0, 1)
    following = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    return 0.5 * float(np.sum(x * following[1] - following[0] * y))


fields = result.fields
moved = fields.points + fields["displacement"][-1]
change = area(moved, fields.connectivity) / area(fields.points, fields.connectivity) - 1.0
print(f"the area changes by {change:.1e} of itself")

# %%
# Colours are von Mises' stress.

draw(result, [0.0, 0.5, 1.0], field="von-mises")
plt.show()

# %%
# The force on a metre of the cord.

figure, axes = plt.subplots(layout="constrained")
axes.plot(result.history["time"], result.history["normal_force"] / 2e3)
axes.set_xlabel("way of the upper plate [mm]")
axes.set_ylabel("force on 1 m of the cord [kN]")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/seal.png'
