"""Functions of time: what drives loads, supports and obstacles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import Discriminator, Field, Tag, model_validator
from typing_extensions import Self

from carom.case.description import PER_DIMENSION, Description, Number
from carom.messages import problem


class Table(Description):
    """Values over time, with straight lines between them; constant before and after.

    Parameters
    ----------
    time
        Times [s], ascending.
    value
        The value at each.
    """

    time: Annotated[tuple[Number, ...], Field(min_length=1)]
    value: Annotated[tuple[Number, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _is_a_function(self) -> Self:
        if len(self.time) != len(self.value):
            raise problem(
                f"must have as many entries as time, {len(self.time)}",
                key="value",
                value=self.value,
            )
        if any(a >= b for a, b in zip(self.time, self.time[1:], strict=False)):
            raise problem("must ascend", key="time", value=self.time)
        return self


def _form(value: object) -> str:
    """Return which of the forms of a signal a value has."""
    if isinstance(value, str):
        return "[text]"
    return "[table]" if isinstance(value, Mapping | Table) else "[number]"


Signal = Annotated[
    Annotated[Number, Tag("[number]")]
    | Annotated[str, Tag("[text]")]
    | Annotated[Table, Tag("[table]")],
    Discriminator(_form),
]
"""A function of time: a number, a formula of ``t`` as text, or a `Table`."""

SignalVector = Annotated[tuple[Signal, ...], PER_DIMENSION]
"""One function of time per space dimension, shape [D]."""
