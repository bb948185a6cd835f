"""Units: whether magnitudes are those of solids in SI units."""

from __future__ import annotations

import math
from collections.abc import Iterator

from carom.building.checking import LARGE, WAVE_SPEEDS
from carom.case.body import RigidBody, materials_of
from carom.case.material import BlatzKo, Material, MooneyRivlin, Ogden, Yeoh
from carom.case.mesh import MeshFile
from carom.doctor.finding import Finding
from carom.doctor.patient import Patient
from carom.doctor.unitless import has_no_units

DENSITIES = (10.0, 25e3)
"""Densities of solids, from foam to osmium [kg/m³]."""

SOLID = (100.0, 2e4)
"""Wave speeds that most solids have [m/s]."""

MIXES = (
    ("moduli in MPa and densities in tonne/mm³ (mm, N, tonne)", 1e6, 1e12),
    ("moduli in MPa", 1e6, 1.0),
    ("moduli in GPa", 1e9, 1.0),
    ("densities in g/cm³", 1.0, 1e3),
    ("moduli in GPa and densities in g/cm³", 1e9, 1e3),
    ("moduli in kPa", 1e3, 1.0),
)
"""Units that are put in by mistake, and what turns moduli and densities into Pa and kg/m³."""

FAST = 0.1
"""Initial velocity over the wave speed, and so about the strain of an impact, that is a lot."""

STRONG_GRAVITY = 100.0
"""Gravity above which millimetres are likely [m/s²]."""


def units(patient: Patient) -> Iterator[Finding]:
    """Look at wave speeds, velocities, gravity and sizes."""
    bodies = patient.description["bodies"]
    seen: set[str] = set()
    for index, (body, built) in enumerate(zip(patient.scenario.bodies, bodies, strict=True)):
        speed = built["wave_speed"]
        if isinstance(body, RigidBody):
            continue
        for name, of in zip(materials_of(body), built["materials"], strict=True):
            if name not in seen:
                seen.add(name)
                yield _waves(name, patient.scenario.materials[name], of["wave_speed"])
        for place, given in _velocities(patient, index):
            if (velocity := math.hypot(*given)) > FAST * speed:
                yield Finding(
                    "warning",
                    place,
                    f"{body.name} moves at {velocity:.4g} m/s, {velocity / speed:.2g} of its wave "
                    "speed: an impact strains it by about as much",
                    "check the velocity's unit (m/s); a law of small strains does not bear this",
                )
        if isinstance(body.mesh, MeshFile) and built["diameter"] > LARGE:
            yield Finding(
                "warning",
                f"bodies.{index}.mesh.scale",
                f"{body.name} is {built['diameter']:.4g} m large",
                f"if its file is in millimetres, set scale = {body.mesh.scale * 1e-3:g}",
            )
    for stage in patient.stages:
        gravity = math.hypot(*(stage.analysis.gravity or ()))
        if gravity > STRONG_GRAVITY:
            yield Finding(
                "warning",
                f"{stage.key}analysis.gravity",
                f"gravity is {gravity:.4g} m/s², that of the Earth is 9.81 m/s²",
                "give it in m/s², not in mm/s²",
            )
            return


def _waves(name: str, material: Material, speed: float) -> Finding:
    """Judge the speed of pressure waves in a material [m/s]."""
    slowest, fastest = WAVE_SPEEDS
    shear = math.sqrt(shear_modulus(material) / material.density)
    key = f"materials.{name}"
    fact = f"pressure waves run at {speed:.4g} m/s and shear waves at {shear:.4g} m/s in {name}"
    if slowest <= speed <= fastest:
        return Finding("ok", key, fact)
    if has_no_units(material.density):
        return Finding("ok", key, f"{fact}; a density of 1 is that of a case without units")
    return Finding(
        "warning",
        key,
        f"{fact}: no solid between foam and diamond has that",
        "give moduli in Pa and the density in kg/m³" + _likely_mix(speed, material.density),
    )


def _velocities(patient: Patient, body: int) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Yield the velocities that a body is given [m/s], with their keys."""
    yield f"bodies.{body}.velocity", patient.scenario.bodies[body].velocity or ()
    for stage in patient.stages:
        for number, given in enumerate(stage.velocities):
            if given.body == patient.scenario.bodies[body].name:
                yield f"{stage.key}velocities.{number}.velocity", given.velocity or ()


def shear_modulus(material: Material) -> float:
    """Return the shear modulus of small strains [Pa]."""
    if isinstance(material, MooneyRivlin):
        return 2.0 * (material.c10 + material.c01)
    if isinstance(material, Yeoh):
        return 2.0 * material.c10
    if isinstance(material, Ogden):
        return 0.5 * sum(m * a for m, a in zip(material.mu, material.alpha, strict=True))
    if isinstance(material, BlatzKo):
        return material.shear
    return 0.5 * material.young / (1.0 + material.poisson)


def _likely_mix(speed: float, density: float) -> str:
    """Return which units may have been put in, if any explain speed and density."""
    low, high = DENSITIES
    likely = [
        mix
        for mix, modulus, mass in MIXES
        if low <= density * mass <= high
        and SOLID[0] <= speed * math.sqrt(modulus / mass) <= SOLID[1]
    ]
    return f"; these look like {', or '.join(likely)}" if likely else ""
