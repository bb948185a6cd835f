"""Looking at a simulation while it goes on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom import _carom
from carom.case.scenario import Scenario
from carom.ledger_terms import Ledger
from carom.running.energy import Energy


@dataclass(frozen=True)
class Contacts:
    """The contacts that press at a moment, n of them in D dimensions.

    A contact is a node of one body, the source, against the surface of another or an obstacle, the
    target. With mortar contact it is the mean of the surroundings of the node. In space it may be
    an edge across an edge of the target; its node is the one that takes more of the reaction.

    Parameters
    ----------
    source, target
        Names of body and of body or obstacle, one each per contact.
    node
        The node among those of the source, shape [n].
    gap
        Gap where the contact condition was written [m], shape [n]; negative is penetration.
    normal
        Unit normals from the target to the source, shape [n, D].
    reaction
        Forces on the source [N], shape [n, D]; the target gets the opposite.
    """

    source: tuple[str, ...]
    target: tuple[str, ...]
    node: NDArray[np.int64]
    gap: NDArray[np.float64]
    normal: NDArray[np.float64]
    reaction: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.node)

    def force(self, on: str, *, by: str | None = None) -> NDArray[np.float64]:
        """Return the contact force on a body or obstacle [N], shape [D].

        Parameters
        ----------
        on
            Name of the body or obstacle.
        by
            Name of the one that presses on it; everything by default.
        """
        total = np.zeros(self.reaction.shape[1])
        for source, target, reaction in zip(self.source, self.target, self.reaction, strict=True):
            if source == on and by in (None, target):
                total += reaction
            if target == on and by in (None, source):
                total -= reaction
        return total


class BodyState:
    """A body as it is now: arrays over its n nodes or cells, in D dimensions.

    Every array is a read-only copy of the moment in which it is asked for.

    Parameters
    ----------
    name
        Its name.
    moment
        What it is read from.
    nodes, cells
        Which points and cells of ``fields.vtkhdf`` are its own.
    """

    def __init__(self, name: str, moment: _Moment, nodes: slice, cells: slice) -> None:
        self.name = name
        self.nodes, self.cells = nodes, cells
        self._moment = moment

    @property
    def points(self) -> NDArray[np.float64]:
        """Reference positions X of the nodes [m], shape [n, D]."""
        return self._moment.points[self.nodes]

    @property
    def displacement(self) -> NDArray[np.float64]:
        """Displacements u [m], shape [n, D]."""
        return self._nodal("displacement")

    @property
    def positions(self) -> NDArray[np.float64]:
        """Where the nodes are, X + u [m], shape [n, D]."""
        return _frozen(self.points + self.displacement)

    @property
    def velocity(self) -> NDArray[np.float64]:
        """Velocities [m/s], shape [n, D]."""
        return self._nodal("velocity")

    @property
    def reaction(self) -> NDArray[np.float64]:
        """Contact forces on the nodes [N], shape [n, D]."""
        return self._nodal("contact_force")

    @property
    def stress(self) -> NDArray[np.float64]:
        """Cauchy stress, mean of each cell [Pa], xx yy zz xy yz xz, shape [n, 6]."""
        return self._cellwise("stress")

    @property
    def strain(self) -> NDArray[np.float64]:
        """Green–Lagrange strain, mean of each cell, xx yy zz xy yz xz, shape [n, 6]."""
        return self._cellwise("strain")

    @property
    def energy_density(self) -> NDArray[np.float64]:
        """Strain energy per reference volume, mean of each cell [J/m³], shape [n]."""
        return self._cellwise("energy_density")

    @property
    def plastic_strain(self) -> NDArray[np.float64]:
        """Equivalent plastic strain, mean of each cell, shape [n]."""
        return self._cellwise("plastic_strain")

    def _nodal(self, name: str) -> NDArray[np.float64]:
        array: NDArray[np.float64] = self._moment.state[name][self.nodes]
        return array

    def _cellwise(self, name: str) -> NDArray[np.float64]:
        return self._moment.fields[name][self.cells]

    def __repr__(self) -> str:
        nodes, cells = (part.stop - part.start for part in (self.nodes, self.cells))
        return f"BodyState({self.name!r}: {nodes} nodes, {cells} cells)"


class State:
    """What a simulation knows of the present; observers of a run are called with it.

    It goes along with the simulation. Arrays do not: they are read-only copies of the moment in
    which they are asked for.
    """

    def __init__(self, scenario: Scenario, native: _carom.Simulation) -> None:
        self._scenario = scenario
        self._native = native
        self._moment = _Moment(native)
        self._bodies = MappingProxyType(dict(_bodies(native, self._moment)))

    @property
    def scenario(self) -> Scenario:
        """What is simulated."""
        return self._scenario

    @property
    def time(self) -> float:
        """Time [s]."""
        return self._native.time

    @property
    def steps(self) -> int:
        """Steps done."""
        return self._native.step

    @property
    def stage(self) -> str:
        """Name of the stage that the run is in; empty in a case without stages."""
        return self._scenario.full_stages()[self._native.stage].name

    @property
    def energy(self) -> Energy:
        """Kinetic and strain energy, and that of springs."""
        now = self._native.progress()
        return Energy(kinetic=now["kinetic"], strain=now["strain"], springs=now["springs"])

    @property
    def ledger(self) -> Ledger:
        """What happened to the energy since the start."""
        return Ledger(**self._native.ledger())

    @property
    def bodies(self) -> Mapping[str, BodyState]:
        """The bodies by name."""
        return self._bodies

    @property
    def contacts(self) -> Contacts:
        """The contacts that press."""
        bodies = [body.name for body in self._scenario.bodies]
        obstacles = [obstacle.name for obstacle in self._scenario.obstacles]
        state = self._moment.state
        first = np.array([body.nodes.start for body in self._bodies.values()])
        nodes: NDArray[np.int64] = state["contact_node"]
        sources = np.searchsorted(first, nodes, side="right") - 1
        return Contacts(
            source=tuple(bodies[index] for index in sources),
            target=tuple(
                bodies[index] if index >= 0 else obstacles[-1 - index]
                for index in state["contact_target"]
            ),
            node=_frozen(nodes - first[sources]),
            gap=state["contact_gap"],
            normal=state["contact_normal"],
            reaction=state["contact_reaction"],
        )

    def __repr__(self) -> str:
        title = self._scenario.title
        of = f"{title!r}: " if title else ""
        return (
            f"{type(self).__name__}({of}{self.steps} of {self._native.steps} steps, "
            f"t = {self.time:g} s)"
        )


class _Moment:
    """The arrays of a native simulation, fetched once per moment."""

    def __init__(self, native: _carom.Simulation) -> None:
        self._native = native
        self.points = _frozen(native.mesh()["points"])
        self.forget()

    def forget(self) -> None:
        """Fetch everything anew when it is asked for."""
        self._state: dict[str, Any] = {"time": None}
        self._fields: tuple[float | None, dict[str, NDArray[np.float64]]] = (None, {})

    @property
    def state(self) -> dict[str, Any]:
        """The nodes and contacts, see ``arrays::state`` of the native module."""
        if self._state["time"] != self._native.time:
            self._state = _frozen_all(self._native.state())
        return self._state

    @property
    def fields(self) -> dict[str, NDArray[np.float64]]:
        """Means of the cells."""
        if self._fields[0] != self._native.time:
            self._fields = self._native.time, _frozen_all(self._native.fields())
        return self._fields[1]


def _bodies(native: _carom.Simulation, moment: _Moment) -> Sequence[tuple[str, BodyState]]:
    bodies, node, cell = [], 0, 0
    for body in native.describe()["bodies"]:
        nodes, cells = slice(node, node + body["nodes"]), slice(cell, cell + body["cells"])
        bodies.append((body["name"], BodyState(body["name"], moment, nodes, cells)))
        node, cell = nodes.stop, cells.stop
    return bodies


def _frozen(array: NDArray[Any]) -> NDArray[Any]:
    array.flags.writeable = False
    return array


def _frozen_all(values: dict[str, Any]) -> dict[str, Any]:
    for value in values.values():
        if isinstance(value, np.ndarray):
            _frozen(value)
    return values
