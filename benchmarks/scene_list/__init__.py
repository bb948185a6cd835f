"""Scenes in which contact goes wrong in other codes, and went wrong in this one.

Each is a function that returns what of a case is its own: bodies, obstacles, times. Sizes are of
the order of a metre, bodies of rubber, and what should come to rest is damped. Erleben's set of
degenerate contacts (Erleben, ACM Trans. Graph. 37, 2018) is among them, written anew.
"""

from . import bullets, folding, obstacles, resting, sharp
from .making import SCENES

__all__ = ["SCENES", "bullets", "folding", "obstacles", "resting", "sharp"]
