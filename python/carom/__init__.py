"""Frictional impact of deformable bodies, every joule accounted for."""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom._carom import __version__
    from carom.auditing import Audit, audit
    from carom.building.checking import Check, check
    from carom.case.analysis import Conserving, Dynamic, Newton, Static, Theta
    from carom.case.body import Body
    from carom.case.contact import Contact, FrictionSolver, Pair
    from carom.case.load import Force, Pressure, Traction
    from carom.case.material import (
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
    from carom.case.mesh import Ball, Box, Cylinder, Disc, MeshFile, Rectangle, Ring, Tube
    from carom.case.motion import Displacement, Fixed, Prescribed
    from carom.case.obstacle import Plane, RigidBox, RigidCylinder, RigidSphere, RigidSurface
    from carom.case.output import Output, Track
    from carom.case.scenario import Scenario
    from carom.case.signal import Table
    from carom.errors import (
        CaromError,
        CaromWarning,
        CertificateError,
        ConvergenceError,
        InputError,
        MeshError,
        StorageError,
    )
    from carom.io.history import read_history
    from carom.io.summary_types import Summary
    from carom.results.field import Field
    from carom.results.fields import Fields
    from carom.results.result import Result
    from carom.running.books import Energy, Ledger
    from carom.running.observer import Observer, Stop
    from carom.running.run import run
    from carom.running.simulation import Simulation, Step
    from carom.running.state import BodyState, Contacts, State
    from carom.system.progress import Progress

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
    "case.analysis": ("Conserving", "Dynamic", "Newton", "Static", "Theta"),
    "auditing": ("Audit", "audit"),
    "case.body": ("Body",),
    "running.books": ("Energy", "Ledger"),
    "building.checking": ("Check", "check"),
    "case.contact": ("Contact", "FrictionSolver", "Pair"),
    "errors": (
        "CaromError",
        "CaromWarning",
        "CertificateError",
        "ConvergenceError",
        "InputError",
        "MeshError",
        "StorageError",
    ),
    "results.field": ("Field",),
    "results.fields": ("Fields",),
    "io.history": ("read_history",),
    "case.load": ("Force", "Pressure", "Traction"),
    "case.material": (
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
    "case.mesh": ("Ball", "Box", "Cylinder", "Disc", "MeshFile", "Rectangle", "Ring", "Tube"),
    "case.motion": ("Displacement", "Fixed", "Prescribed"),
    "running.observer": ("Observer", "Stop"),
    "case.obstacle": ("Plane", "RigidBox", "RigidCylinder", "RigidSphere", "RigidSurface"),
    "case.output": ("Output", "Track"),
    "system.progress": ("Progress",),
    "results.result": ("Result",),
    "running.run": ("run",),
    "case.scenario": ("Scenario",),
    "case.signal": ("Table",),
    "running.simulation": ("Simulation", "Step"),
    "running.state": ("BodyState", "Contacts", "State"),
    "io.summary_types": ("Summary",),
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
