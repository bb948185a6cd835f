"""Contact problems with Coulomb friction on their own: w = W r + q, without finite elements.

References
----------
.. [1] G. de Saxcé, Z.-Q. Feng, *The bipotential method: a constructive approach to design the
   complete contact law with friction and improved numerical algorithms*, Mathematical and Computer
   Modelling 28 (1998) 225–245.
.. [2] V. Acary, M. Brémond, T. Koziara, F. Pérignon, *FCLIB: a collection of discrete 3D frictional
   contact problems*, INRIA technical report 0444 (2014).
"""

from carom.friction.files import (
    FCLIB_SUFFIXES,
    check_suffix,
    read,
    read_record,
    write,
    write_record,
)
from carom.friction.global_problem import GlobalProblem
from carom.friction.measure import Measure, measure, project
from carom.friction.problem import Problem
from carom.friction.record import Iterate, Record
from carom.friction.solution import Solution
from carom.friction.solve import DEFAULT_ITERATIONS, SOLVERS, solve
from carom.friction.symmetry import AsymmetryWarning

__all__ = [
    "DEFAULT_ITERATIONS",
    "FCLIB_SUFFIXES",
    "SOLVERS",
    "AsymmetryWarning",
    "GlobalProblem",
    "Iterate",
    "Measure",
    "Problem",
    "Record",
    "Solution",
    "check_suffix",
    "measure",
    "project",
    "read",
    "read_record",
    "solve",
    "write",
    "write_record",
]
