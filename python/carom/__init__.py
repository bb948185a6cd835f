"""Frictional impact of deformable bodies, every joule accounted for."""

from importlib import import_module
from types import ModuleType

from carom._carom import __version__
from carom.analysis import Conserving, Dynamic, Newton, Static, Theta
from carom.audit import Audit, audit
from carom.body import Body
from carom.books import Energy, Ledger
from carom.checking import Check, check
from carom.contact import Contact, FrictionSolver, Pair
from carom.errors import (
    CaromError,
    CertificateError,
    ConvergenceError,
    InputError,
    MeshError,
    StorageError,
)
from carom.io.history import read_history
from carom.load import Force, Pressure, Traction
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
from carom.mesh import Ball, Box, Cylinder, Disc, MeshFile, Rectangle, Ring, Tube
from carom.motion import Displacement, Fixed, Prescribed
from carom.observer import Observer, Stop
from carom.obstacle import Plane, RigidBox, RigidCylinder, RigidSphere, RigidSurface
from carom.output import Output, Track
from carom.progress import Progress
from carom.result import Result
from carom.running import run
from carom.scenario import Scenario
from carom.signal import Table
from carom.simulation import Simulation, Step
from carom.state import BodyState, Contacts, State

__all__ = [
    "Audit",
    "Ball",
    "BlatzKo",
    "Body",
    "BodyState",
    "Box",
    "CaromError",
    "CertificateError",
    "Check",
    "Conserving",
    "Contact",
    "Contacts",
    "ConvergenceError",
    "Cylinder",
    "Damping",
    "Disc",
    "Displacement",
    "Dynamic",
    "Energy",
    "Fixed",
    "Force",
    "FrictionSolver",
    "InputError",
    "J2Plasticity",
    "Ledger",
    "LinearElastic",
    "MeshError",
    "MeshFile",
    "MooneyRivlin",
    "NeoHookean",
    "Newton",
    "Observer",
    "Ogden",
    "Output",
    "Pair",
    "Plane",
    "Prescribed",
    "Pressure",
    "Progress",
    "Rectangle",
    "Result",
    "RigidBox",
    "RigidCylinder",
    "RigidSphere",
    "RigidSurface",
    "Ring",
    "SaintVenantKirchhoff",
    "Scenario",
    "Simulation",
    "State",
    "Static",
    "Step",
    "Stop",
    "StorageError",
    "Table",
    "Theta",
    "Track",
    "Traction",
    "Tube",
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
