"""FCLIB files: contact problems in HDF5, in the layout of the Frictional Contact Library [1]_.

A local problem has W, q and mu under ``fclib_local``, a global one M, H, f, w (here b) and mu
under ``fclib_global``. Matrices are stored as CSparse has them: ``nz`` is −1 for compressed
columns, −2 for compressed rows, or the number of triplets.

References
----------
.. [1] https://frictionalcontactlibrary.github.io
"""

from carom.friction.fclib.reading import read, read_problem
from carom.friction.fclib.writing import write

__all__ = ["read", "read_problem", "write"]
