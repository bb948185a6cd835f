"""Bodies of other codes in steps of carom, of which it asks mass, energy, force and stiffness."""

from carom.foreign.body import ForeignBody
from carom.foreign.run import ForeignRun, ForeignStep

__all__ = ["ForeignBody", "ForeignRun", "ForeignStep"]
