"""
A part from Gmsh falls on the floor
===================================

A bracket, meshed by Gmsh in millimetres, is thrown at a rigid floor. This page uses a coarse mesh
with linear tetrahedra so that it is made in seconds; ``examples/gmsh_part.py`` has 55,000 nodes.
"""

from pathlib import Path
from tempfile import mkdtemp

import gmsh_part
import matplotlib.pyplot as plt
from pictures import draw

import carom

MESH = Path(gmsh_part.__file__).parents[1] / "docs" / "gallery" / "bracket.msh"
scenario = gmsh_part.scenario(MESH)
result = carom.run(scenario, out=mkdtemp())
energy = result.summary["energy"]
print(f"{result.summary['dofs']} unknowns, {result.summary['steps']} steps")
print(f"friction took {energy['friction'] / energy['initial']:.1%} of the energy")

# %%
# The whole case; ``scale`` makes metres of the millimetres of the file:
#
# .. literalinclude:: ../../examples/gmsh_part.py
#    :pyobject: scenario

draw(result, [1.2e-4, 3.6e-4], field="von-mises")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/thumbnail-bracket.png'
