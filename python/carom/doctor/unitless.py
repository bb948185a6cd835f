"""Cases without units, such as those of papers, in which a unit of mass is chosen."""

from __future__ import annotations


def has_no_units(density: float) -> bool:
    """Return whether a density says that a case has no units: it is 1, and no solid's in kg/m³.

    Foam has 10 kg/m³, and what is 1 g/cm³ is rarely just that. Another number leaves the question
    open, so that moduli in GPa beside densities in kg/m³ are still warned of.
    """
    return density == 1.0
