"""What a step would take beyond one machine: a model, and what it was calibrated by.

Nothing here is run on many ranks. What one core takes is measured (docs/speed.md); what a network
takes, and how work splits, are assumptions that stand below. Prints the tables of
docs/beyond-one-machine.md:

    .venv/bin/python benchmarks/beyond.py
"""

from __future__ import annotations

import math
from dataclasses import dataclass

# Measured on one core, docs/speed.md: a ball of 217,311 unknowns makes 1 iteration per step in
# flight in 77.8 ms, within 298 MiB.
PER_UNKNOWN = 77.8e-3 / 217_311
UNKNOWN_BYTES = 298 * 2**20 / 217_311
# A block on 5,041 nodes: 361 ms per step in contact and 152 in flight, 5.3 iterations; friction
# solvers take 18 % of the former.
ITERATIONS = 5.3
PER_CONTACT = (361e-3 - 152e-3) / 5_041
FRICTION_PER_CONTACT = 0.18 * 361e-3 / 5_041
# Sweeps that friction solvers make per iteration where many contacts press on one another, and what
# more it takes where contacts are parted among ranks: by half, as levels of the graph of W on two
# threads showed (record 40 of docs/decisions).
SWEEPS = 30
PARTED = 1.5

# Counted from what is stored. A node of the surface that is copied to every rank: displacement,
# velocity, motion, contact force and residual of three components, box and place of a facet.
SURFACE_NODE_BYTES = 5 * 24 + 96
# A contact has rows of W and of the compliance with the 49 nodes within three cells, blocks of 9.
CONTACT_BYTES = 2 * 49 * 72

# Assumed of the network: seconds per message, bytes per second and rank.
LATENCY = 2e-6
BANDWIDTH = 5e9
# Neighbours of a part of a body, and products with the matrix per iteration: the polynomial's terms
# and the forces.
NEIGHBOURS = 6
PRODUCTS = 8
# Sums over all ranks per iteration.
SUMS = 4

SIZES = (1e7, 1e8, 1e9)
CONTACTS = (1e5, 1e6, 1e7)
RANKS = (10, 100, 1_000, 10_000)


@dataclass(frozen=True)
class Step:
    """Seconds of a step in contact, and bytes per rank."""

    volume: float
    network: float
    contacts: float
    memory: float

    @property
    def time(self) -> float:
        """All of it [s]."""
        return self.volume + self.network + self.contacts


def surface_nodes(unknowns: float) -> float:
    """Return how many nodes a cube of so many unknowns has on its sides."""
    return 6.0 * (unknowns / 3.0) ** (2.0 / 3.0)


def bodies(unknowns: float, ranks: float) -> tuple[float, float]:
    """Return what cells and products take per step, and what their neighbours' values do [s]."""
    own = unknowns / ranks
    halo = surface_nodes(own) * 24.0
    exchange = NEIGHBOURS * LATENCY + halo / BANDWIDTH
    sums = SUMS * LATENCY * math.log2(ranks)
    return ITERATIONS * own * PER_UNKNOWN, ITERATIONS * (PRODUCTS * exchange + sums)


def replicated(unknowns: float, contacts: float, ranks: float) -> Step:
    """Every rank has the whole surface and solves the whole contact problem."""
    volume, network = bodies(unknowns, ranks)
    # Motions at contacts are summed over all ranks, forward and back.
    network += ITERATIONS * (2.0 * 24.0 * contacts / BANDWIDTH + LATENCY * math.log2(ranks))
    memory = (
        unknowns / ranks * UNKNOWN_BYTES
        + surface_nodes(unknowns) * SURFACE_NODE_BYTES
        + contacts * CONTACT_BYTES
    )
    return Step(volume, network, contacts * PER_CONTACT, memory)


def parted(unknowns: float, contacts: float, ranks: float) -> Step:
    """Contacts have a partition of their own, balanced by their number."""
    volume, network = bodies(unknowns, ranks)
    own = contacts / ranks
    # A part of a surface is a patch: what its rim of three cells feels is exchanged in every sweep.
    rim = 3.0 * 4.0 * math.sqrt(own) * 24.0
    sweep = NEIGHBOURS * LATENCY + rim / BANDWIDTH + LATENCY * math.log2(ranks)
    network += ITERATIONS * (SWEEPS * PARTED * sweep + 2.0 * 24.0 * own / BANDWIDTH)
    work = PER_CONTACT + (PARTED - 1.0) * FRICTION_PER_CONTACT
    copied = surface_nodes(unknowns) / ranks * 4.0
    memory = (
        unknowns / ranks * UNKNOWN_BYTES + copied * SURFACE_NODE_BYTES + own * CONTACT_BYTES * 2.0
    )
    return Step(volume, network, own * work, memory)


def ends_at(unknowns: float, ranks: float) -> float:
    """Return how many contacts take as long, replicated, as all else of a step."""
    volume, network = bodies(unknowns, ranks)
    return (volume + network) / PER_CONTACT


def figure(x: float) -> str:
    """Return two digits."""
    if x >= 10.0:
        return f"{float(f'{x:.2g}'):,.0f}"
    return f"{x:.2g}"


def main() -> None:
    """Print the tables."""
    print("| unknowns | contacts | ranks | replicated [s] | [GB] | parted [s] | [GB] |")
    print("|---|---|---|---|---|---|---|")
    for unknowns, contacts in zip(SIZES, CONTACTS, strict=True):
        for ranks in RANKS:
            steps = replicated(unknowns, contacts, ranks), parted(unknowns, contacts, ranks)
            cells = [figure(x) for s in steps for x in (s.time, s.memory / 1e9)]
            head = [f"10^{math.log10(x):.0f}" for x in (unknowns, contacts)]
            print("| " + " | ".join([*head, f"{ranks:,}", *cells]) + " |")
    print()
    print("| unknowns per rank | ranks | contacts |")
    print("|---|---|---|")
    for own in (1e4, 1e5, 1e6):
        for ranks in (100, 10_000):
            share = ends_at(own * ranks, ranks)
            print(f"| {own:,.0f} | {ranks:,} | {figure(share)} |")


if __name__ == "__main__":
    main()
