"""
A contact problem on its own, from an FCLIB file
================================================

A wall of blocks on a shaken floor, as a problem of contact alone: M, H, f, b and μ, written to an
FCLIB file, read again, and solved by every solver of carom. No finite elements are involved, and
the file could come from any other code.
"""

from pathlib import Path
from tempfile import mkdtemp

import matplotlib.pyplot as plt
import numpy as np
import scipy.sparse as sp

from carom import friction

STEP, GRAVITY, MASS = 1e-3, 9.81, 1.0  # s, m/s², kg
WIDTH, HEIGHT = 0.2, 0.1  # of a block [m]
ROWS, COLUMNS = 8, 6

# %%
# Every block rests with two points of its lower side on the blocks below, or on the floor. A column
# of H for each normal and each tangential impulse says how it changes the momenta of the two;
# motions of a block are (v_x, v_y, ω).

blocks = [
    (row, (column + 0.5 * (row % 2)) * WIDTH) for row in range(ROWS) for column in range(COLUMNS)
]
columns = []
for upper, (row, x) in enumerate(blocks):
    for corner in (-0.4 * WIDTH, 0.4 * WIDTH):
        below = [
            lower
            for lower, (r, at) in enumerate(blocks)
            if r == row - 1 and abs(x + corner - at) <= 0.5 * WIDTH
        ]
        if row > 0 and not below:
            continue  # it overhangs
        normal, tangential = np.zeros(3 * len(blocks)), np.zeros(3 * len(blocks))
        normal[3 * upper : 3 * upper + 3] = [0.0, 1.0, corner]
        tangential[3 * upper : 3 * upper + 3] = [1.0, 0.0, 0.5 * HEIGHT]
        for lower in below[:1]:
            arm = x + corner - blocks[lower][1]
            normal[3 * lower : 3 * lower + 3] = [0.0, -1.0, -arm]
            tangential[3 * lower : 3 * lower + 3] = [-1.0, 0.0, 0.5 * HEIGHT]
        columns += [normal, tangential]
H = sp.csc_matrix(np.array(columns).T)
inertia = MASS * (WIDTH**2 + HEIGHT**2) / 12.0
M = sp.diags(np.tile([MASS, MASS, inertia], len(blocks)), format="csc")
f = np.tile([0.3 * MASS * GRAVITY * STEP, -MASS * GRAVITY * STEP, 0.0], len(blocks))
contacts = H.shape[1] // 2
problem = friction.GlobalProblem(M, H, f, np.zeros((contacts, 2)), np.full(contacts, 0.25))

file = Path(mkdtemp()) / "wall.hdf5"
friction.write(problem, file, title="A wall that is shaken")
again = friction.read(file)
print(f"{contacts} contacts of {len(blocks)} blocks")

# %%
# Every solver on the same file, with the iterations that it takes; residuals are measured anew.

figure, axes = plt.subplots(layout="constrained")
for solver in friction.SOLVERS:
    found = friction.solve(again, solver=solver, time_limit=2.0)
    print(f"{solver:27} {found.status:16} residual {found.residual:.1e} by {found.iterations}")
    axes.loglog(1 + found.history[:, 0], found.history[:, 1], "o-", markersize=3, label=solver)
axes.set_xlabel("iterations (+ 1)")
axes.set_ylabel("residual")
axes.legend(fontsize=7)
plt.show()

# sphinx_gallery_thumbnail_path = 'images/gallery/fclib.png'
