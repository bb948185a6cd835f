"""Frictional impact of deformable bodies, every joule accounted for."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom._carom import __version__
    from carom.analysis import Conserving, Dynamic, Newton, Static, Theta
    from carom.auditing import Audit, audit
    from carom.body import Body
    from carom.books import Energy, Ledger
    from carom.checking import Check, check
    from carom.contact import Contact, FrictionSolver, Pair
    from carom.errors import (
        CaromError,
        CaromWarning,
        CertificateError,
        ConvergenceError,
        InputError,
        MeshError,
        StorageError,
    )
    from carom.fields import Field, Fields
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
    from carom.summary import Summary

__all__ = [
    "Audit",
    "Ball",
    "BlatzKo",
    "Body",
    "BodyState",
    "Box",
    "CaromError",
    "CaromWarning",
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
    "Field",
    "Fields",
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
    "Summary",
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

_HOMES = {
    "_carom": ("__version__",),
    "analysis": ("Conserving", "Dynamic", "Newton", "Static", "Theta"),
    "auditing": ("Audit", "audit"),
    "body": ("Body",),
    "books": ("Energy", "Ledger"),
    "checking": ("Check", "check"),
    "contact": ("Contact", "FrictionSolver", "Pair"),
    "errors": (
        "CaromError",
        "CaromWarning",
        "CertificateError",
        "ConvergenceError",
        "InputError",
        "MeshError",
        "StorageError",
    ),
    "fields": ("Field", "Fields"),
    "io.history": ("read_history",),
    "load": ("Force", "Pressure", "Traction"),
    "material": (
        "BlatzKo",
        "Damping",
        "J2Plasticity",
        "LinearElastic",
        "MooneyRivlin",
        "NeoHookean",
        "Ogden",
        "SaintVenantKirchhoff",
        "Viscosity",
        "Yeoh",
    ),
    "mesh": ("Ball", "Box", "Cylinder", "Disc", "MeshFile", "Rectangle", "Ring", "Tube"),
    "motion": ("Displacement", "Fixed", "Prescribed"),
    "observer": ("Observer", "Stop"),
    "obstacle": ("Plane", "RigidBox", "RigidCylinder", "RigidSphere", "RigidSurface"),
    "output": ("Output", "Track"),
    "progress": ("Progress",),
    "result": ("Result",),
    "running": ("run",),
    "scenario": ("Scenario",),
    "signal": ("Table",),
    "simulation": ("Simulation", "Step"),
    "state": ("BodyState", "Contacts", "State"),
    "summary": ("Summary",),
}
"""The module of each name, imported when the name is first used: the command line starts sooner."""

_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}


if not TYPE_CHECKING:  # type checkers know the names, and that there are no others

    def __getattr__(name: str) -> object:
        if name == "friction":
            return import_module("carom.friction")
        if name not in _HOME_OF:
            raise AttributeError(f"module 'carom' has no attribute {name!r}")
        value: object = getattr(import_module(f"carom.{_HOME_OF[name]}"), name)
        globals()[name] = value
        return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, "friction"})
