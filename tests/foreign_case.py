"""A case of triangles in which bodies are those of another code."""

import carom
from carom.building.build import build
from plain_fem import Triangles, outer_edges


def foreign_bodies(case):
    """Return the bodies of a case, all of triangles, by the other code."""
    mesh = build(case).mesh()
    cells = mesh["connectivity"].reshape(-1, 3)
    out = []
    for index, body in enumerate(case.bodies):
        law = case.materials[body.material]
        own = cells[mesh["body"] == index]
        first = own.min()
        points = mesh["points"][first : own.max() + 1]
        fem = Triangles(
            points, own - first, young=law.young, poisson=law.poisson, density=law.density
        )
        out.append(
            carom.ForeignBody(
                body.name,
                points,
                outer_edges(own - first),
                mass=fem.mass,
                energy=fem.energy,
                force=fem.force,
                stiffness=fem.stiffness,
                velocity=body.velocity,
                cells={"triangle": own - first},
            )
        )
    return out


def with_bodies(case, bodies):
    """Return the case with other bodies."""
    return carom.Scenario(**{**dict(case), "bodies": bodies})
