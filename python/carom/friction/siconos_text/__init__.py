"""Text files of Siconos Numerics [1]_: the dimension, the number of contacts, matrices, vectors.

A local problem is W, q, mu, a global one M, H, f, b, mu, with M v = H r + f and w = Hᵀ v + b. A
matrix is stored dense (0), in blocks (1) or as CSparse prints it (2).

References
----------
.. [1] https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos
"""

from carom.friction.siconos_text.reading import read
from carom.friction.siconos_text.writing import write

__all__ = ["read", "write"]
