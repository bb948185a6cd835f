"""Impacts that leave waves behind, and impacts that turn round."""

from __future__ import annotations

import warnings

import oblique_spheres
import zener

import carom
from sections.layout import percent, power, signed, table

INELASTICITIES = (0.05, 0.1, 0.2, 0.5, 1.0)
MESHES = ((1.0, 4, 100), (1.0, 8, 200), (0.1, 4, 100))
"""Speed [m/s], cells along 1.4 radii of the contact, steps in the time of Hertz's contact."""

PLATES = """\
## A sphere on a plate

A steel sphere of 10 mm strikes a plate of steel from which no wave returns, a body of revolution
(`tests/validation/zener.py`); the thickness, {thick:.1f} mm to {thin:.1f} mm at 1 m/s, makes
Zener's λ. His equation is integrated by `scipy.integrate.solve_ivp`. It knows the plate as one
without thickness and the sphere as a half space where they touch; both are the better the slower
the impact.

Coefficients of restitution, by the speed and the cells over 1.4 radii of the
contact, and what they are off Zener's. Conserving, midpoint; the defect of the books is at most
{defect} E₀. Asserted in `test_zener.py`.

{table}
"""


def plates_section() -> str:
    """Let the sphere strike plates of five thicknesses."""
    rows, worst = [], 0.0
    for inelasticity in INELASTICITIES:
        wanted = zener.restitution(inelasticity)
        row = [f"{inelasticity:g}", f"{wanted:.4f}"]
        for speed, divisions, steps in MESHES:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", carom.CaromWarning)
                found = zener.strike(inelasticity, speed=speed, divisions=divisions, steps=steps)
            worst = max(worst, found.defect)
            off = signed(found.restitution - wanted, 4)
            row.append(f"{found.restitution:.4f} ({off})")
            print(f"         λ = {inelasticity:g}, {speed:g} m/s, {divisions} cells", flush=True)
        rows.append(row)
    names = [f"{speed:g} m/s, {divisions} cells" for speed, divisions, _ in MESHES]
    thick, thin = (1e3 * zener.thickness(k, 1.0) for k in (INELASTICITIES[0], INELASTICITIES[-1]))
    return PLATES.format(
        thick=thick, thin=thin, defect=power(worst), table=table(("λ", "Zener", *names), rows)
    )


INCIDENCES = (1.0, 3.0, 6.0)
DIVISIONS, STEPS = 3, 60

THROWS = """\
## A sphere thrown obliquely

A steel sphere of 10 mm is thrown at a floor of steel at {speed:g} m/s and an angle,
μ = {friction:g} (`tests/validation/oblique_spheres.py`): half of it in space, {cells:.1f} cells
over a radius of the contact, {steps} steps in its time. ψ₁ = κ v_t/(μ v_n) is the tangential
speed of the point that touches before, ψ₂ that after the impact, over the same v_n.

Maw, Barber & Fawcett's equations (Wear 38, 1976) are solved on 50 rings of uniform traction with
displacements by elliptic integrals, which share nothing with carom; with twice as many ψ₂ changes
by no more than 8e-4. χ = {chi:.4f}: from ψ₁ = 4χ − 1 = {gross:.3f} on all slips throughout, and
ψ₂ = ψ₁ − 4χ. In between the point that touches comes back the way it came. Differences are in
terms of 4χ, what slipping throughout would take. Asserted in `test_oblique_spheres.py`.

{table}
"""


def throws_section() -> str:
    """Throw the sphere at three angles."""
    rows = []
    for incidence in INCIDENCES:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", carom.CaromWarning)
            found = oblique_spheres.throw(incidence, divisions=DIVISIONS, steps=STEPS)
        wanted = oblique_spheres.rebound(incidence, rings=50, steps=200)
        print(f"         ψ₁ = {incidence:g}", flush=True)
        off = (found.rebound - wanted) / (4 * oblique_spheres.CHI)
        rows.append(
            (
                f"{incidence:g}",
                signed(wanted, 3),
                signed(found.rebound, 3),
                percent(off, 1),
                f"{found.restitution:.4f}",
                power(found.defect),
            )
        )
    return THROWS.format(
        speed=oblique_spheres.SPEED,
        friction=oblique_spheres.FRICTION,
        cells=DIVISIONS / 1.4,
        steps=STEPS,
        chi=oblique_spheres.CHI,
        gross=4 * oblique_spheres.CHI - 1,
        table=table(("ψ₁", "ψ₂, theory", "ψ₂, carom", "off", "normal e", "defect / E₀"), rows),
    )
