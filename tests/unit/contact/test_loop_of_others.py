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


def take_through(case, steps, solver=lambda factor: factor.solve, mass_of=lambda _: None):
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
        mass=mass_of(fem),
    )
    gives_back = mass_of(fem) is not None
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
        new = 2 * d / TIME_STEP - v
        step = touch.accept(at(d), velocity=new.reshape(-1, 2) if gives_back else None)
        ledger.add(step)
        u, v = u + d, new + step.velocity_change if gives_back else new
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


MASSES = {
    "matrix": lambda fem: fem.mass,
    "function": lambda fem: lambda vector: fem.mass @ vector,
}


@pytest.mark.parametrize("kind", MASSES)
def test_a_mass_gets_back_what_landing_takes_as_in_a_run_of_carom(kind, tmp_path):
    """Contacts land and rub from step 24 on; later they chatter, and round-off grows."""
    case = scenario(60, "midpoint", "smooth")
    expected = of_carom(case, tmp_path)
    found, _ = take_through(case, 60, mass_of=MASSES[kind])
    initial = found[0, :2].sum()
    # Measured: 3e-14.
    assert np.abs(found - expected).max() < 3e-13 * initial
    assert expected[-1, 2] > 5e-4 * initial, "they rub"
    without, _ = take_through(case, 60)
    assert without[-1, 3] > 1e-4 * initial, "landing takes something"


def test_what_landing_takes_is_given_back_to_the_end():
    found, ledger = take_through(scenario(120, "midpoint", "smooth"), 120, mass_of=MASSES["matrix"])
    initial = found[0, :2].sum()
    # Measured: 6e-15.
    assert abs(ledger.normal_contact) < 6e-14 * initial
    assert ledger.friction > 0.001 * initial
