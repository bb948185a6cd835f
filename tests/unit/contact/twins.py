"""The examples in C and Fortran, done by `carom.contact`: same bodies, same scheme, other code."""

import numpy as np

import carom
from carom import contact


def bars(cells=20, steps=120, dt=2.5e-4):
    """Two bars of two rows of nodes meet: time, kinetic, strain energy, normal work every 10th."""
    length, height, young, density, speed, gap = 1.0, 0.1, 1e4, 1.0, 1.0, 1e-3
    number = np.arange(4 * (cells + 1)).reshape(2, cells + 1, 2)
    points = np.empty((number.size, 2))
    v = np.empty(number.size)
    mass, stiffness = np.empty(number.size), np.zeros((number.size, number.size))
    spring = young * height / 2 / (length / cells)
    for bar, nodes in enumerate(number):
        points[nodes, 0] = bar * (length + gap) + np.arange(cells + 1)[:, None] * (length / cells)
        points[nodes, 1] = [0.0, height]
        v[nodes] = -speed if bar else speed
        mass[nodes] = density * height / 2 * length / cells
        mass[nodes[[0, -1]]] /= 2
        for a, b in zip(nodes[:-1].ravel(), nodes[1:].ravel(), strict=True):
            stiffness[[a, b], [a, b]] += spring
            stiffness[[a, b], [b, a]] -= spring
    surfaces = [
        contact.Surface(name, [*zip(n[:-1].ravel(), n[1:].ravel(), strict=True), n[0], n[-1]])
        for name, n in zip(("left", "right"), number, strict=True)
    ]
    unknowns = np.column_stack([np.arange(number.size), np.full(number.size, -1)])
    touch = contact.ContactModel(points, surfaces, dofs=unknowns)
    matrix = 2 * np.diag(mass) / dt**2 + stiffness / 2
    ledger, u, rows = contact.Ledger(), np.zeros(number.size), []

    def at(u):
        return points + np.column_stack([u, 0 * u])

    for step in range(1, steps + 1):
        velocity = np.column_stack([v, 0 * v])
        candidates = touch.search(at(u), velocity=velocity, time_step=dt)
        free = np.linalg.solve(matrix, 2 * mass * v / dt - stiffness @ u)
        d = dt * v
        while candidates is not None:
            for _ in range(20):
                contacts = touch.evaluate(candidates, at(u + d))
                found = contact.solve(contacts, lambda b: np.linalg.solve(matrix, b), free=free)
                correction = np.abs(found.motion - d).max()
                d = found.motion
                if correction <= 1e-15:
                    break
            candidates = touch.missed(at(u + d))
        ledger.add(touch.accept(at(u + d)))
        u, v = u + d, 2 * d / dt - v
        if step % 10 == 0:
            strain = 0.5 * u @ stiffness @ u
            rows.append([touch.time, 0.5 * mass @ v**2, strain, ledger.normal_contact])
    return np.array(rows)


def incline(slopes=((0.5, 500), (0.1, 700))):
    """A block of springs slides down slopes: time, energies, works and path every 50th step."""
    return np.concatenate([_slide(slope, steps) for slope, steps in slopes])


def _slide(slope, steps):
    dt, spring, gravity, friction = 1e-3, 1e4, 9.81, 0.3
    down = np.array([np.cos(slope), 0.0, -np.sin(slope)])
    normal = np.array([np.sin(slope), 0.0, np.cos(slope)])
    bits = np.arange(8)[:, None] >> np.arange(3) & 1
    points = bits @ np.stack([down, [0.0, 1.0, 0.0], normal])
    stiffness = np.zeros((8, 3, 8, 3))
    for a in range(8):
        for b in range(a):
            along = points[a] - points[b]
            block = spring * np.outer(along, along) / (along @ along)
            for p, q, sign in ((a, a, 1), (b, b, 1), (a, b, -1), (b, a, -1)):
                stiffness[p, :, q, :] += sign * block
    stiffness = stiffness.reshape(24, 24)
    matrix = np.eye(24) / dt**2 + stiffness
    sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
    touch = contact.ContactModel(
        points,
        [contact.Surface("block", sides)],
        [carom.Plane(name="incline", point=[0.0, 0.0, 0.0], normal=list(normal))],
        friction=friction,
        theta=1.0,
    )
    ledger, u, v, rows = contact.Ledger(), np.zeros(24), np.tile(down, 8), []
    weight = np.tile([0.0, 0.0, gravity], 8)
    for step in range(1, steps + 1):
        start = points + u.reshape(8, 3)
        candidates = touch.search(start, velocity=v.reshape(8, 3), time_step=dt)
        free = np.linalg.solve(matrix, v / dt - stiffness @ u - weight)
        d = dt * v
        while candidates is not None:
            contacts = touch.evaluate(candidates, start + d.reshape(8, 3))
            found = contact.solve(contacts, lambda b: np.linalg.solve(matrix, b), free=free)
            d = found.motion
            candidates = touch.missed(start + d.reshape(8, 3))
        ledger.add(touch.accept(start + d.reshape(8, 3)))
        u, v = u + d, d / dt
        if step % 50 == 0:
            potential = 0.5 * u @ stiffness @ u + weight @ u
            path = u.reshape(8, 3).mean(axis=0) @ down
            works = [ledger.friction, ledger.normal_contact]
            rows.append([touch.time, 0.5 * v @ v, potential, *works, path])
    return np.array(rows)
