"""What every part of a scenario is made of: plain, frozen data with checked values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    model_validator,
)

from carom.messages import input_error, known, problem

DIMENSION = 2
"""Number of space dimensions."""


def _plain_name(name: str) -> str:
    if not name or any(c in "./\\" or c.isspace() or not c.isprintable() for c in name):
        raise ValueError(
            "a name has at least one printable character and no '.', '/', '\\' or space"
        )
    return name


def _per_dimension(values: tuple[Any, ...]) -> tuple[Any, ...]:
    if len(values) != DIMENSION:
        raise ValueError(f"must have {DIMENSION} components, not {len(values)}")
    return values


PER_DIMENSION = AfterValidator(_per_dimension)
"""Asks of a tuple one entry per space dimension."""

Number = Annotated[float, Field(strict=True)]
"""A finite number; integers are taken, text and truth values are not."""

Positive = Annotated[float, Field(strict=True, gt=0)]
"""A number greater than zero."""

NonNegative = Annotated[float, Field(strict=True, ge=0)]
"""A number of zero or more."""

Count = Annotated[int, Field(strict=True, ge=1, le=1_000_000_000)]
"""An integer of one or more, and at most 10⁹."""

Vector = Annotated[tuple[Number, ...], PER_DIMENSION]
"""One number per space dimension, shape [2]."""

Name = Annotated[str, AfterValidator(_plain_name)]
"""A name that can be a part of a dotted path, of a column title and of a file name."""


class Description(BaseModel):
    """Base of every part of a scenario.

    Values are checked when an object is made, and cannot be set afterwards. What is wrong is
    raised as `carom.InputError`.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    def __init__(self, **data: Any) -> None:  # noqa: ANN401 (checked here)
        try:
            super().__init__(**data)
        except ValidationError as error:
            raise input_error(error, data) from None

    # Tells pydantic that this __init__ only validates, so that nested tables keep their path.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @model_validator(mode="before")
    @classmethod
    def _refuse_unknown_keys(cls, data: object) -> object:
        for key in data if isinstance(data, Mapping) else ():
            if key not in cls.model_fields:
                raise problem(f"unknown key; {known(str(key), cls.model_fields)}", key=str(key))
        return data
