"""
Corner on corner
================

Of two squares one falls with its corner on that of the other, which two blocks hold upright. It
slides off to one side, and the two come to lie face on face.
"""

from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import meshio
import numpy as np
from pictures import draw

import carom


def on_its_corner(height: float, cells: int = 6) -> str:
    """Write a unit square that stands on its corner with its centre in this height [m]."""
    s = np.linspace(-0.5, 0.5, cells + 1)
    x, y = (values.ravel() for values in np.meshgrid(s, s, indexing="ij"))
    points = np.column_stack([(x - y) / 2**0.5, (x + y) / 2**0.5 + height, 0 * x])
    number = np.arange(len(x)).reshape(cells + 1, cells + 1)
    corners = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    file = Path(mkdtemp()) / "square.vtu"
    meshio.write_points_cells(file, points, [("quad", np.stack(corners, -1).reshape(-1, 4))])
    return str(file)


scenario = carom.Scenario(
    title="Corner on corner",
    analysis=carom.Dynamic(end_time=1.5, time_step=2e-3, gravity=[0.0, -9.81]),
    output=carom.Output(fields_every=0.02),
    materials={
        "rubber": carom.NeoHookean(
            young=1e6, poisson=0.3, density=1000.0, damping=carom.Damping(mass=2.0, stiffness=1e-3)
        )
    },
    bodies=[
        carom.Body(name=name, material="rubber", mesh=carom.MeshFile(file=on_its_corner(height)))
        for name, height in (("below", 0.72), ("above", 2.25))
    ],
    obstacles=[
        carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0]),
        carom.RigidBox(name="left", corner=[-1.2, 0.0], size=[0.6, 0.4]),
        carom.RigidBox(name="right", corner=[0.6, 0.0], size=[0.6, 0.4]),
    ],
    contact=carom.Contact(friction=0.3),
)
result = carom.run(scenario, out=mkdtemp())
print(f"deepest penetration {result.summary['penetration']['max_depth']:.0e} m")

# %%
# Colours are von Mises' stress.

draw(result, [0.1, 0.7, 1.1], field="von-mises")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/corners.png'
