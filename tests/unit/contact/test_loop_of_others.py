"""Contact in a time loop that is not carom's gives what a run of carom gives."""

import numpy as np
import pytest
from scipy.sparse.linalg import splu

import carom
from carom import contact
from carom.building.build import build
from grazing_discs import LAW, TIME_STEP, discs
from plain_fem import Triangles, outer_edges

FRICTION = 0.2


def scenario(steps, condition, targets, obstacles=(), pairs=()):
    return discs(steps, condition, FRICTION, targets=targets, obstacles=obstacles, pairs=pairs)


def take_through(case, steps, solver=lambda factor: factor.solve):
    """Energies and friction of a loop of its own over the mesh of a case, step by step."""
    mesh = build(case).mesh()
    points, cells = mesh["points"], mesh["connectivity"].reshape(-1, 3)
    fem = Triangles(points, cells, **LAW)
    owner = np.empty(len(points), dtype=int)
    owner[cells] = mesh["body"][:, None]
    surfaces = [
        contact.Surface(body.name, outer_edges(cells[mesh["body"] == index]))
        for index, body in enumerate(case.bodies)
    ]
    touch = contact.ContactModel(
        points,
        surfaces,
        case.obstacles,
        condition=case.contact.condition,
        friction=case.contact.friction,
        targets=case.contact.targets,
        pairs=case.contact.pairs,
    )
    ledger = contact.Ledger()
    u = np.zeros(fem.count)
    v = np.array([body.velocity for body in case.bodies])[owner].ravel()
    force = fem.force(u)
    rows = []
    for _ in range(steps):
        at = lambda d, u=u: points + (u + d).reshape(-1, 2)  # noqa: E731
        candidates = touch.search(at(0.0), velocity=v.reshape(-1, 2), time_step=TIME_STEP)
        d = TIME_STEP * v
        while candidates is not None:
            for _ in range(30):
                residual = fem.mass @ (2 * d / TIME_STEP**2 - 2 * v / TIME_STEP)
                residual += 0.5 * (force + fem.force(u + d))
                factor = splu((2 * fem.mass / TIME_STEP**2 + 0.5 * fem.stiffness(u + d)).tocsc())
                contacts = touch.evaluate(candidates, at(d))
                free = d - factor.solve(residual)
                found = contact.solve(contacts, solver(factor), free=free)
                correction = np.abs(found.motion - d).max()
                d = found.motion
                if correction < 1e-15:
                    break
            assert correction < 1e-13
            candidates = touch.missed(at(d))
        ledger.add(touch.accept(at(d)))
        u, v = u + d, 2 * d / TIME_STEP - v
        force = fem.force(u)
        rows.append([0.5 * v @ fem.mass @ v, fem.energy(u), ledger.friction, ledger.normal_contact])
    return np.array(rows), ledger


def of_carom(case, out):
    history = carom.run(case, out=out).history
    terms = ("kinetic", "strain", "friction", "normal_contact")
    return np.column_stack([history[term][1:] for term in terms])


@pytest.mark.parametrize(
    ("condition", "targets"), [("gap", "smooth"), ("gap", "faceted"), ("endpoint", "smooth")]
)
def test_a_loop_of_ones_own_gives_what_carom_gives(condition, targets, tmp_path):
    case = scenario(120, condition, targets)
    expected = of_carom(case, tmp_path)
    found, ledger = take_through(case, 120)
    initial = found[0, :2].sum()
    # Measured: 4e-13.
    assert np.abs(found - expected).max() < 4e-12 * initial
    assert ledger.certificate < 1e-11 * initial
    assert expected[-1, 2] > 0.001 * initial, "they rub"
