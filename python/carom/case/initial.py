"""The state that a case starts from, where bodies are not as they are drawn."""

from __future__ import annotations

from pydantic import model_validator
from typing_extensions import Self

from carom.case.description import Description, FilePath, Positive
from carom.messages import problem


class InitialDisplacement(Description):
    """Where the nodes of a body are when the case starts.

    Elastic bodies are under the stress of it; plastic ones begin without plastic strain.

    Parameters
    ----------
    body
        Name of the body.
    file
        Displacements of its nodes [m] as a file of NumPy, ``.npy``, shape [node_count, D]; None
        takes those of `result`. Nodes are in the order of the mesh, as in ``fields.vtkhdf``.
    result
        Results directory of a run with a body of this name and this mesh, whose last displacements
        are taken; None takes those of `file`.
    """

    body: str
    file: FilePath | None = None
    result: FilePath | None = None

    @model_validator(mode="after")
    def _comes_from_somewhere(self) -> Self:
        if (self.file is None) == (self.result is None):
            raise problem("give file or result, one of the two")
        return self


class Initial(Description):
    """The state that a case starts from; left out, bodies are as they are drawn.

    Parameters
    ----------
    result
        Results directory of a run that completed, of the same bodies, obstacles and pairs. The case
        goes on where that run ended: with its displacements, velocities, plastic strain and contact
        forces, and at its time. Prescribed displacements are those since then. None starts at
        t = 0.
    time
        When that run ended [s], its ``end_time``: this case starts then.
    displacements
        Displacements of single bodies, at t = 0.
    """

    result: FilePath | None = None
    time: Positive | None = None
    displacements: tuple[InitialDisplacement, ...] = ()

    @property
    def start_time(self) -> float:
        """When the case starts [s]."""
        return self.time or 0.0

    @model_validator(mode="after")
    def _says_one_thing(self) -> Self:
        if self.result is None and not self.displacements:
            raise problem("says nothing; give result or displacements, or leave it out")
        if self.result is not None and self.displacements:
            raise problem(
                "a result has displacements of all bodies; leave these out", key="displacements"
            )
        if self.result is not None and self.time is None:
            raise problem("required key is missing: when the result ended", key="time")
        if self.result is None and self.time is not None:
            raise problem(
                "displacements are those at t = 0; leave the time out", key="time", value=self.time
            )
        first_use: dict[str, int] = {}
        for index, entry in enumerate(self.displacements):
            if entry.body in first_use:
                raise problem(
                    f"body already displaced by initial.displacements.{first_use[entry.body]}",
                    key=f"displacements.{index}.body",
                    value=entry.body,
                )
            first_use[entry.body] = index
        return self
