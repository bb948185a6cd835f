"""
Taylor's bar: how strong is copper that flows?
==============================================

A copper bar hits a rigid wall at 227 m/s. Nearly all of its energy becomes plastic flow at the
foot, and the length that is left tells how strong the metal was. This is
``examples/taylor_bar.toml`` on a coarse mesh.
"""

# %%
# .. literalinclude:: ../../examples/taylor_bar.py
#    :pyobject: plane

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import taylor_bar
from pictures import draw

import carom

result = carom.run(taylor_bar.plane(2, 20, 2e-7), out=mkdtemp())
energy = result.summary["energy"]
length = taylor_bar.LENGTH + result.history["tail.u_y"][-1]
print(f"the bar is {1e3 * length:.2f} mm long, published are 21.4 to 21.5 mm")
print(f"plastic flow took {energy['plastic'] / energy['initial']:.1%} of the energy")

# %%
# Half of the section, which turned about its left side is the bar. Colours are the plastic strain.

draw(result, [0.0, 2e-5, 8e-5], field="plastic_strain")
plt.show()

# sphinx_gallery_thumbnail_path = 'images/thumbnail-taylor.png'
