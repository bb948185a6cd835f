"""Frictional impact of deformable bodies, every joule accounted for."""

from importlib import import_module
from types import ModuleType

from carom._carom import Simulation, __version__
from carom.analysis import Conserving, Dynamic, Newton, Theta
from carom.audit import Audit, audit
from carom.body import Body
from carom.checking import Check, check
from carom.contact import Contact, FrictionSolver, Pair
from carom.errors import (
    CaromError,
    CertificateError,
    ConvergenceError,
    InputError,
    MeshError,
)
from carom.io.history import read_history
from carom.material import (
    BlatzKo,
    Damping,
    J2Plasticity,
    LinearElastic,
    MooneyRivlin,
    NeoHookean,
    Ogden,
    SaintVenantKirchhoff,
    Viscosity,
    Yeoh,
)
from carom.mesh import Box, Disc, Rectangle
from carom.obstacle import Plane, RigidBox, RigidCylinder, RigidSphere
from carom.output import Output, Track
from carom.result import Result
from carom.scenario import Scenario
from carom.simulation import Progress, run

__all__ = [
    "Audit",
    "BlatzKo",
    "Body",
    "Box",
    "CaromError",
    "CertificateError",
    "Check",
    "Conserving",
    "Contact",
    "ConvergenceError",
    "Damping",
    "Disc",
    "Dynamic",
    "FrictionSolver",
    "InputError",
    "J2Plasticity",
    "LinearElastic",
    "MeshError",
    "MooneyRivlin",
    "NeoHookean",
    "Newton",
    "Ogden",
    "Output",
    "Pair",
    "Plane",
    "Progress",
    "Rectangle",
    "Result",
    "RigidBox",
    "RigidCylinder",
    "RigidSphere",
    "SaintVenantKirchhoff",
    "Scenario",
    "Simulation",
    "Theta",
    "Track",
    "Viscosity",
    "Yeoh",
    "__version__",
    "audit",
    "check",
    "read_history",
    "run",
]


def __getattr__(name: str) -> ModuleType:
    """Import `carom.friction`, and scipy with it, where it is first used."""
    if name == "friction":
        return import_module("carom.friction")
    raise AttributeError(f"module 'carom' has no attribute {name!r}")
