"""
Oblique impact of a layer: stick or slip, exactly
=================================================

An elastic layer falls obliquely on a rough floor. Plane waves solve the problem exactly, friction
included: a layer that falls steeply sticks and loses nothing, one that falls flat slips and loses
a known part of its energy. ``examples/oblique_layer.py``, for three ratios of the tangential to
the normal velocity.
"""

# %%
# .. literalinclude:: ../../examples/oblique_layer.py
#    :pyobject: scenario

from tempfile import mkdtemp

import matplotlib.pyplot as plt
import oblique_layer

import carom

figure, axes = plt.subplots(layout="constrained")
for ratio, exact in ((0.2, 0.0), (1.0, 0.24), (2.0, 0.64)):
    result = carom.run(oblique_layer.scenario(ratio=ratio), out=mkdtemp())
    unit = oblique_layer.WIDTH * oblique_layer.SPEED**2
    lost = result.history["friction"] / unit
    print(f"v_t/v_n = {ratio}: {lost[-1]:.4f} lost, exact {exact}")
    (line,) = axes.plot(result.history["time"], lost, label=f"$v_t/v_n$ = {ratio}")
    axes.axhline(exact, color=line.get_color(), linestyle=":")
axes.set_xlabel("time [s]")
axes.set_ylabel(r"dissipated by friction [$\rho H v_n^2$]; dotted: exact")
axes.legend()
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/oblique-layer.png'
