"""
A wedge between two blocks
==========================

A sharp wedge is driven into the gap between two blocks and throws them apart.
"""

from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import meshio
import numpy as np
from pictures import draw

import carom

s, t = (x.ravel() for x in np.meshgrid(np.linspace(-0.5, 0.5, 3), np.linspace(0, 1, 9)))
points = np.column_stack([s * (0.02 + 0.5 * t), 1.0 + t, 0 * t])
number = np.arange(len(s)).reshape(9, 3)
corners = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
file = Path(mkdtemp()) / "wedge.vtu"
meshio.write_points_cells(file, points, [("quad", np.stack(corners, -1).reshape(-1, 4))])

wedge = carom.Body(
    name="wedge", material="rubber", mesh=carom.MeshFile(file=str(file)), velocity=[0.0, -3.0]
)
blocks = [
    carom.Body(
        name=name,
        material="rubber",
        mesh=carom.Rectangle(corner=[x, 0.0], size=[0.99, 1.0], divisions=[5, 5]),
    )
    for name, x in (("left", -1.0), ("right", 0.01))
]
scenario = carom.Scenario(
    title="A wedge between two blocks",
    analysis=carom.Dynamic(end_time=0.5, time_step=1e-3, gravity=[0.0, -9.81]),
    output=carom.Output(fields_every=0.02),
    materials={"rubber": carom.NeoHookean(young=1e6, poisson=0.3, density=1000.0)},
    bodies=[*blocks, wedge],
    obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
    contact=carom.Contact(friction=0.1),
)
result = carom.run(scenario, out=mkdtemp())
print(f"deepest penetration {result.summary['penetration']['max_depth']:.0e} m")

# %%
# Colours are von Mises' stress.

draw(result, [0.0, 0.1, 0.5], field="von-mises")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/wedge.png'
