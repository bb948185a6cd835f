"""
Planted in another code: discs of scikit-fem
============================================

The bodies, their forces and the time loop are scikit-fem's; carom finds what touches and solves
contact with friction, in some ten lines of the loop. This is ``examples/scikit_fem_discs.py``.
"""

import matplotlib.pyplot as plt
import scikit_fem_discs

# %%
# The loop:
#
# .. literalinclude:: ../../examples/scikit_fem_discs.py
#    :pyobject: collide

discs = scikit_fem_discs.Discs(refinements=2)
run = scikit_fem_discs.collide(discs, end_time=0.6)
initial = run.kinetic[0] + run.strain[0] + run.friction[0]
print(f"friction took {run.friction[-1]:.4f} J of {initial:.4f} J")
print(f"no contact of any step is farther than {run.ledger.certificate:.0e} J from Coulomb's law")

# %%
# Energies by scikit-fem, and what carom's books say of friction.

time = [scikit_fem_discs.TIME_STEP * (1 + k) for k in range(len(run.kinetic))]
figure, axes = plt.subplots(layout="constrained")
axes.plot(time, run.kinetic, label="kinetic")
axes.plot(time, run.strain, label="strain")
axes.plot(time, run.friction, label="friction")
axes.set_xlabel("time [s]")
axes.set_ylabel("energy, of 1 m of depth [J]")
axes.legend()
plt.show()

# sphinx_gallery_thumbnail_path = 'images/thumbnail-scikit-fem.png'
