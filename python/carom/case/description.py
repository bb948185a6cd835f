"""What every part of a scenario is made of: plain, frozen data with checked values."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, get_args

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ValidationError,
    model_validator,
)
from pydantic.fields import FieldInfo

from carom.messages import input_error, known, problem


def _plain_name(name: str) -> str:
    if not name or any(c in "./\\" or c.isspace() or not c.isprintable() for c in name):
        raise ValueError(
            "a name has at least one printable character and no '.', '/', '\\' or space"
        )
    return name


def _of_length(length: int) -> Callable[[tuple[Any, ...]], tuple[Any, ...]]:
    def check(values: tuple[Any, ...]) -> tuple[Any, ...]:
        if len(values) != length:
            raise ValueError(f"must have {length} components, not {len(values)}")
        return values

    return check


class PerDimension:
    """Marks a tuple with one entry per space dimension; `Scenario` checks their number."""


PER_DIMENSION = PerDimension()
"""Asks of a tuple one entry per space dimension."""

Number = Annotated[float, Field(strict=True)]
"""A finite number; integers are taken, text and truth values are not."""

Positive = Annotated[float, Field(strict=True, gt=0)]
"""A number greater than zero."""

Share = Annotated[float, Field(strict=True, gt=0, le=1)]
"""A number greater than zero, and one at most."""

NonNegative = Annotated[float, Field(strict=True, ge=0)]
"""A number of zero or more."""

Count = Annotated[int, Field(strict=True, ge=1, le=1_000_000_000)]
"""An integer of one or more, and at most 10⁹."""

Vector = Annotated[tuple[Number, ...], PER_DIMENSION]
"""One number per space dimension, shape [D]."""

InPlane = AfterValidator(_of_length(2))
"""Asks of a tuple two entries."""

InSpace = AfterValidator(_of_length(3))
"""Asks of a tuple three entries."""

PlaneVector = Annotated[tuple[Number, ...], InPlane]
"""Two numbers, shape [2]."""

SpaceVector = Annotated[tuple[Number, ...], InSpace]
"""Three numbers, shape [3]."""

Name = Annotated[str, AfterValidator(_plain_name)]
"""A name that can be a part of a dotted path, of a column title and of a file name."""


FilePath = Annotated[str, AfterValidator(lambda file: str(Path(file).absolute()))]
"""A file, kept as an absolute path: a results directory has a case file too, which must find it."""


def _plain(value: object) -> object:
    """Return numbers and arrays of NumPy, also in lists, as those of Python."""
    if type(value) is list:
        return [_plain(member) for member in value]
    if type(value) is tuple:
        return tuple(_plain(member) for member in value)
    return value.tolist() if hasattr(value, "dtype") and hasattr(value, "tolist") else value


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
        if not isinstance(data, Mapping):
            return data
        for key in data:
            if key not in cls.model_fields:
                raise problem(f"unknown key; {known(str(key), cls.model_fields)}", key=str(key))
        return {key: _plain(value) for key, value in data.items()}

    def given(self, key: str) -> Any:  # noqa: ANN401 (of any field)
        """Return the value of a field as the case file gives it."""
        return getattr(self, key)

    def vectors(self, path: str = "") -> Iterator[tuple[str, tuple[float, ...]]]:
        """Yield what has one entry per space dimension here and below, with its dotted path."""
        for name, field in type(self).model_fields.items():
            key, value = f"{path}{name}", getattr(self, name)
            if isinstance(value, Description):
                yield from value.vectors(f"{key}.")
            elif isinstance(value, tuple) and PER_DIMENSION in asked_of(field):
                yield key, value
            elif isinstance(value, tuple):
                for index, entry in enumerate(value):
                    if isinstance(entry, Description):
                        yield from entry.vectors(f"{key}.{index}.")


def asked_of(field: FieldInfo) -> list[object]:
    """Return what is asked of the value of a field, or of one member of its union."""
    members = get_args(field.annotation)
    return [*field.metadata, *(a for part in members for a in getattr(part, "__metadata__", ()))]
