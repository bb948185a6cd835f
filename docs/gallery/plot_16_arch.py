"""
A masonry arch: stones that only press and rub
==============================================

A thick arch of loose stones stands and a thin one falls: its line of thrust no longer fits inside.
Heyman's thinnest semicircular arch has a thickness of 0.1075 of its mean radius. This is
``examples/masonry_arch.py``.
"""

from pathlib import Path
from tempfile import mkdtemp

import masonry_arch
import matplotlib.pyplot as plt
from pictures import draw

import carom

results = {}
for thickness in (0.15, 0.08):
    scenario = masonry_arch.scenario(Path(mkdtemp()), thickness, 0.3)
    results[thickness] = carom.run(scenario, out=mkdtemp())
    crown = results[thickness].fields.body("stone-13")["displacement"][-1][:, 2].mean()
    print(f"thickness {thickness} m: after 0.3 s the crown is {1e3 * -crown:.2f} mm lower")

# %%
# The thin arch turns about hinges at its joints, inside and outside by turns. Each colour is a
# stone.

result = results[0.08]
draw(result, [0.0, 0.2, 0.3], field="body", camera=(-65.0, 14.0))
plt.show()

# %%
# One stone, and the whole case:
#
# .. literalinclude:: ../../examples/masonry_arch.py
#    :pyobject: stone
# .. literalinclude:: ../../examples/masonry_arch.py
#    :pyobject: scenario

# sphinx_gallery_thumbnail_path = 'images/thumbnail-arch.png'
