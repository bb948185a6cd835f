"""
A pile of grains: forces run in chains
======================================

Forty-five grains of many sizes fall into a box. What one bears, it has from a few of its
neighbours, so that stress runs through the pile in chains. This is ``examples/pile.toml``.
"""

from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import two_bars
from pictures import draw

import carom

EXAMPLES = Path(two_bars.__file__).parent
result = carom.run(carom.Scenario.from_toml(EXAMPLES / "pile.toml"), out=mkdtemp())
history = result.history
print(f"deepest penetration {result.summary['penetration']['max_depth']:.0e} m")
defect = result.summary["energy"]["max_defect"]
print(f"not explained: {defect:.0e} J of the {history['external'][-1]:.0f} J that gravity gave")

# %%
# Colours are von Mises' stress.

draw(result, [0.0, 0.25, 0.5], field="von-mises")
plt.show()

# %%
# What gravity gave: some still moves, little is strain, friction and damping have the rest.

figure, axes = plt.subplots(layout="constrained")
for term in ("external", "kinetic", "strain", "friction", "viscous"):
    axes.plot(history["time"], history[term], label=term)
axes.set_xlabel("time [s]")
axes.set_ylabel("energy, of 1 m of depth [J]")
axes.legend()
plt.show()

# %%
# The whole case:
#
# .. literalinclude:: ../../examples/pile.toml
#    :language: toml

# sphinx_gallery_thumbnail_path = 'images/thumbnail-pile.png'
