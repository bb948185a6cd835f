"""
A press fit: Lamé's pressure from an interference
=================================================

A shaft that is 20 µm too thick is pressed into a hub. The pressure between them follows from
elasticity alone, and Lamé gave it in closed form. This is ``examples/press_fit.toml``.
"""

import math
from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import two_bars
from pictures import draw

import carom

EXAMPLES = Path(two_bars.__file__).parent
result = carom.run(carom.Scenario.from_toml(EXAMPLES / "press_fit.toml"), out=mkdtemp())

# %%
# Long parts of one material with radii a and b, in plane strain:
# p = E δ (b² − a²) / [2 (1 − ν²) a b²].

young, poisson, inner, outer, excess = 210e9, 0.3, 0.02, 0.04, 20e-6
lame = young * excess * (outer**2 - inner**2) / (2 * (1 - poisson**2) * inner * outer**2)
pressure = result.history["normal_force"] / (2.0 * math.pi * inner)
print(f"pressure {pressure[-1] / 1e6:.2f} MPa, Lamé {lame / 1e6:.2f} MPa")

# %%
# Colours are von Mises' stress: the hub bears most of it, the shaft is under even pressure.

draw(result, [1.0], field="von-mises", edges=False)
plt.show()

# %%
# The whole case:
#
# .. literalinclude:: ../../examples/press_fit.toml
#    :language: toml

# sphinx_gallery_thumbnail_path = 'images/thumbnail-press-fit.png'
