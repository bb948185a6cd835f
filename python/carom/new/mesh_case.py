"""A case about the part in a mesh file, made from what the file tells of it."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from string import Template
from types import MappingProxyType

import numpy as np

from carom.building.build import build
from carom.case.analysis import Dynamic
from carom.case.body import Body
from carom.case.material import SaintVenantKirchhoff
from carom.case.mesh import MeshFile
from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.mesh_file import body_dimension, read_body_mesh
from carom.messages import known
from carom.new.template import MESH_FILE, template


@dataclass(frozen=True)
class Elastic:
    """Typical values of a material.

    Parameters
    ----------
    young
        Young's modulus [Pa].
    poisson
        Poisson's ratio.
    density
        Mass per volume [kg/m³].
    """

    young: float
    poisson: float
    density: float


MATERIALS = MappingProxyType(
    {
        "steel": Elastic(210e9, 0.3, 7850.0),
        "aluminium": Elastic(70e9, 0.33, 2700.0),
        "titanium": Elastic(114e9, 0.34, 4430.0),
        "copper": Elastic(120e9, 0.34, 8960.0),
        "glass": Elastic(70e9, 0.22, 2500.0),
        "concrete": Elastic(30e9, 0.2, 2400.0),
        "epoxy": Elastic(3e9, 0.35, 1200.0),
        "polycarbonate": Elastic(2.4e9, 0.37, 1200.0),
        "polyethylene": Elastic(1e9, 0.42, 950.0),
        "rubber": Elastic(5e6, 0.45, 1100.0),
    }
)
"""Materials by name; values as textbooks round them."""

UNITS = MappingProxyType({"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254})
"""Units of length that mesh files are in, in metres."""

CROSSINGS = 20
"""How often a pressure wave crosses the part until the run ends."""

MOST_STEPS = 2000
"""Steps of the run, at the most."""

STRAIN = 2e-3
"""Velocity of the impact over the wave speed: about the strain that it makes."""

LARGEST_VELOCITY = 5.0
"""Velocity of the impact, at the most [m/s]."""

GAP = 1e-3
"""Distance between part and floor at the start, over the size of the part."""


def mesh_case(mesh: Path, file: Path, *, unit: str = "m", material: str = "steel") -> str:
    """Return the text of a case in which the part of a mesh file is thrown at a floor.

    Parameters
    ----------
    mesh
        The mesh file.
    file
        Where the case will be: the path of the mesh is written relative to it.
    unit
        Unit of the mesh file's coordinates, one of `UNITS`.
    material
        One of `MATERIALS`.

    Raises
    ------
    InputError
        The unit or the material is not known, or the mesh makes no body.
    """
    for option, name, names in (("unit", unit, UNITS), ("material", material, MATERIALS)):
        if name not in names:
            raise InputError(f"--{option} {name}: {known(name, names)}")
    if not mesh.is_file():
        raise InputError(f"--mesh {mesh}: no such file")
    scale, values, key = UNITS[unit], MATERIALS[material], "bodies.0.mesh"
    dimension = body_dimension(mesh, key=key)
    arrays = read_body_mesh(mesh, body=None, scale=scale, space=dimension, key=key)
    (body,) = build(_alone(mesh, dimension, scale, material), []).describe()["bodies"]
    points, up = arrays.points, [0.0] * (dimension - 1) + [1.0]
    low, high = points.min(axis=0), points.max(axis=0)
    size = float(np.max(high - low))
    speed, edge = body["wave_speed"], body["smallest_edge"]
    impact = _rounded(min(LARGEST_VELOCITY, STRAIN * speed), digits=2)
    gap = GAP * size
    end = gap / impact + CROSSINGS * size / speed
    step = _rounded(max(edge / speed, end / MOST_STEPS), digits=2)
    end = math.ceil(end / step) * step
    floor = 0.5 * (low + high)
    floor[-1] = low[-1] - gap
    return Template(template(MESH_FILE)).substitute(
        title=_text(f"{mesh.stem} on a floor"),
        dimension=dimension,
        end_time=f"{end:.12g}",
        time_step=f"{step:g}",
        crossings=CROSSINGS,
        fields_every=f"{max(_rounded(end / 100, digits=2), step):g}",
        gravity=_vector([-9.81 * x for x in up]),
        material=material,
        young=f"{values.young:g}",
        poisson=f"{values.poisson:g}",
        density=f"{values.density:g}",
        file=_text(_relative(mesh, file.parent)),
        scale=f"{scale:g}",
        velocity=_vector([-impact * x for x in up]),
        point=_vector([_rounded(x, digits=6) for x in floor]),
        normal=_vector(up),
        sets=", ".join(_text(name) for name in arrays.facet_sets) or "it has none",
    )


def _alone(mesh: Path, dimension: int, scale: float, material: str) -> Scenario:
    """Return a scenario of the part alone, to ask the native core about it."""
    values = MATERIALS[material]
    return Scenario(
        dimension=dimension,
        analysis=Dynamic(end_time=1.0, time_step=1.0),
        materials={
            material: SaintVenantKirchhoff(
                young=values.young, poisson=values.poisson, density=values.density
            )
        },
        bodies=[
            Body(name="part", material=material, mesh=MeshFile(file=str(mesh), scale=scale)),
        ],
    )


def _relative(mesh: Path, directory: Path) -> str:
    """Return the path of the mesh as seen from the case, absolute if there is no way."""
    try:
        return Path(os.path.relpath(mesh, directory)).as_posix()
    except ValueError:  # another drive
        return mesh.absolute().as_posix()


def _rounded(value: float, *, digits: int) -> float:
    return float(f"{value:.{digits}g}")


def _text(value: str) -> str:
    """Return a text as TOML; what JSON escapes TOML escapes alike."""
    return json.dumps(value, ensure_ascii=False)


def _vector(values: Iterable[float]) -> str:
    return f"[{', '.join(repr(float(x) + 0.0) for x in values)}]"
