"""What reading a damaged file may raise."""

from __future__ import annotations

DAMAGE = (AttributeError, IndexError, KeyError, OSError, RuntimeError, TypeError, ValueError)
"""What h5py and NumPy raise where groups stand for arrays, or where shapes, types or bytes of an
HDF5 file are wrong. A file that can be opened need not be one that can be read."""
