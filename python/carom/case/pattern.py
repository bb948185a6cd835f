"""Many bodies out of one: on a grid, at random, or where a list says."""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import BeforeValidator, Field, model_validator
from typing_extensions import Self

from carom.case.body import DescribedBody, Region, RigidBody, of_kind
from carom.case.contact import Pair
from carom.case.description import (
    PER_DIMENSION,
    Count,
    Description,
    FilePath,
    NonNegative,
    Number,
    Positive,
    SpaceVector,
    Vector,
)
from carom.case.packing import packed
from carom.case.placing import centre, placed, reach
from carom.messages import problem

Seed = Annotated[int, Field(strict=True, ge=0)]
"""What random numbers follow from: the same seed, the same numbers."""

LARGEST = 46_000
"""Bodies beyond these have more pairs than there are numbers for."""


class Copy(NamedTuple):
    """Where a copy is, and what it has beside the body that is repeated."""

    at: tuple[float, ...]
    scale: float = 1.0
    velocity: tuple[float, ...] | None = None
    spin: float | tuple[float, ...] | None = None


class Grid(Description):
    """Places in rows, columns and layers; the first is that of the body as it is drawn.

    Parameters
    ----------
    counts
        Copies along every axis, shape [D].
    spacing
        Distance from one to the next along every axis [m], shape [D].
    shift
        By how much every other row, in space every other layer, is moved [m], shape [D], as the
        courses of a wall are.
    jitter
        Largest distance along every axis by which copies are off their places at random [m].
    seed
        Of the random numbers.
    """

    kind: Literal["grid"] = "grid"
    counts: Annotated[tuple[Count, ...], PER_DIMENSION]
    spacing: Vector
    shift: Vector | None = None
    jitter: NonNegative = 0.0
    seed: Seed = 0

    def copies(self, body: DescribedBody) -> Iterator[Copy]:
        """Yield the copies of a body, along the first axis first."""
        first = centre(body.mesh, len(self.counts))
        shift = self.shift or (0.0,) * len(first)
        random = Random(self.seed)
        for reverse in itertools.product(*(range(n) for n in reversed(self.counts))):
            odd = reverse[0] % 2
            place = [
                x + k * step + odd * by
                for x, k, step, by in zip(
                    first, reversed(reverse), self.spacing, shift, strict=True
                )
            ]
            off = [self.jitter * (2.0 * random.random() - 1.0) for _ in place]
            yield Copy(tuple(x + d for x, d in zip(place, off, strict=True)))

    @property
    def count(self) -> int:
        """Number of copies."""
        return math.prod(self.counts)


class RandomPlaces(Description):
    """Random places in a box, so that no copy is within another.

    Copies are kept apart by circles or balls around them, and put one after the other where there
    is room: of equal discs about half of a box can be filled so, of balls a third.

    Parameters
    ----------
    count
        Number of copies.
    corner
        Corner of the box of the smallest coordinates [m], shape [D]. Copies are wholly inside.
    size
        Sides of the box [m], shape [D].
    gap
        Least distance between two copies, and to the sides of the box [m].
    scales
        Smallest and largest size of a copy, as a multiple of the body's; all sizes between are
        equally frequent. None is that of the body.
    speed
        Largest speed that copies have in random directions beside the velocity of the body [m/s].
    seed
        Of the random numbers.
    """

    kind: Literal["random"] = "random"
    count: Count
    corner: Vector
    size: Annotated[tuple[Positive, ...], PER_DIMENSION]
    gap: NonNegative = 0.0
    scales: tuple[Positive, Positive] | None = None
    speed: NonNegative = 0.0
    seed: Seed = 0

    @model_validator(mode="after")
    def _scales_ascend(self) -> Self:
        if self.scales is not None and self.scales[0] > self.scales[1]:
            what = "must be the smallest size, then the largest"
            raise problem(what, key="scales", value=self.scales)
        return self

    def copies(self, body: DescribedBody) -> Iterator[Copy]:
        """Yield the copies of a body."""
        radius = reach(body.mesh)
        if radius is None:
            raise problem(
                "the size of a mesh in a file is not known here; put its copies on a grid or in a "
                "list",
                key="at.kind",
                value=self.kind,
            )
        random = Random(self.seed)
        low, high = self.scales or (1.0, 1.0)
        scales = [low + (high - low) * random.random() for _ in range(self.count)]
        radii = [radius * scale for scale in scales]
        places = packed(radii, self.corner, self.size, gap=self.gap, random=random)
        if len(places) < self.count:
            raise problem(
                f"there is room for {len(places)} of {self.count}; take a larger box, fewer or "
                "smaller bodies, or a grid",
                key="at.count",
                value=self.count,
            )
        for place, scale in zip(places, scales, strict=True):
            yield Copy(place, scale, self._velocity(body, random))

    def _velocity(self, body: DescribedBody, random: Random) -> tuple[float, ...] | None:
        if self.speed == 0.0:
            return None
        own = body.velocity or (0.0,) * len(self.corner)
        while True:
            way = [2.0 * random.random() - 1.0 for _ in own]
            if math.hypot(*way) <= 1.0:
                return tuple(v + self.speed * w for v, w in zip(own, way, strict=True))


class ListedPlaces(Description):
    """Places that are listed, here or in a file of comma-separated values.

    Parameters
    ----------
    file
        The file, whose first line names its columns: ``x``, ``y`` and in space ``z``; as one likes
        ``scale``, ``vx``, ``vy``, ``vz`` and ``spin``, in space ``spin_x``, ``spin_y`` and
        ``spin_z``. It is read at once: what the case keeps are the lists below, in their units.
    places
        Where the middles of the copies are [m], shape [n, D]; of a mesh from a file, where the
        origin of that is.
    scales
        How large they are, as multiples of the body, shape [n]; none are as large as the body.
    velocities
        Initial velocities [m/s], shape [n, D]; none are that of the body.
    spins
        Initial angular velocities [rad/s], a number or, in space, a vector for each; none are that
        of the body.
    """

    kind: Literal["list"] = "list"
    file: FilePath | None = None
    places: tuple[Vector, ...] = ()
    scales: tuple[Positive, ...] = ()
    velocities: tuple[Vector, ...] = ()
    spins: tuple[Number | SpaceVector, ...] = ()

    @model_validator(mode="after")
    def _reads_its_file(self) -> Self:
        if self.file is not None:
            if self.places:
                raise problem("give file or places, one of the two", key="file", value=self.file)
            for name, column in _columns(self.file).items():
                object.__setattr__(self, name, column)
            object.__setattr__(self, "file", None)
        for name in ("scales", "velocities", "spins"):
            column = getattr(self, name)
            if column and len(column) != len(self.places):
                what = f"must have as many entries as places ({len(self.places)})"
                raise problem(f"{what}, not {len(column)}", key=name)
        if not self.places:
            raise problem("give file or places", key="places")
        return self

    def vectors(self, path: str = "") -> Iterator[tuple[str, tuple[float, ...]]]:
        """Yield every place and velocity with its dotted path."""
        for name in ("places", "velocities"):
            for index, vector in enumerate(getattr(self, name)):
                yield f"{path}{name}.{index}", vector

    def copies(self, body: DescribedBody) -> Iterator[Copy]:
        """Yield the copies of a body."""
        for k, place in enumerate(self.places):
            yield Copy(
                place,
                self.scales[k] if self.scales else 1.0,
                self.velocities[k] if self.velocities else None,
                self.spins[k] if self.spins else None,
            )

    @property
    def count(self) -> int:
        """Number of copies."""
        return len(self.places)


class Pattern(Description):
    """A body that is there many times.

    The copies are bodies like all others, under the name of the body and a number: ``grain-1``,
    ``grain-2`` and so on. In pairs of contact the name alone stands for all of them.

    Parameters
    ----------
    body
        The body that is repeated.
    at
        Where its copies are.
    """

    body: Annotated[DescribedBody, BeforeValidator(of_kind)]
    at: Annotated[Grid | RandomPlaces | ListedPlaces, Field(discriminator="kind")]

    def bodies(self, dimension: int) -> list[DescribedBody]:
        """Return the copies in a space of this dimension.

        Raises
        ------
        PydanticCustomError
            There is no room for them, or they are of another dimension.
        """
        if self.at.count > LARGEST:
            what = f"more than {LARGEST} bodies have more pairs than there are numbers for"
            raise problem(what, key="at", value=self.at.count)
        if self.body.mesh.dimension not in (None, dimension):
            # Said of the body itself, with what would be right.
            return [self.body]
        _check_lengths(self.at, dimension)
        return [
            self.body.model_copy(update=_own(self.body, number, copy))
            for number, copy in enumerate(self.at.copies(self.body), 1)
        ]


def _own(body: DescribedBody, number: int, copy: Copy) -> dict[str, Any]:
    """Return what of a copy differs from the body that is repeated."""
    own: dict[str, Any] = {
        "name": f"{body.name}-{number}",
        "mesh": placed(body.mesh, copy.at, copy.scale),
    }
    if not isinstance(body, RigidBody):
        middle = centre(body.mesh, len(copy.at))
        own["regions"] = tuple(
            _moved(region, middle, copy.at, copy.scale) for region in body.regions
        )
    if copy.velocity is not None:
        own["velocity"] = copy.velocity
    if copy.spin is not None:
        own["spin"] = copy.spin
    return own


def _moved(region: Region, middle: Vector, at: Vector, scale: float) -> Region:
    """Return a region as it is in a copy with its centre elsewhere, so many times as large."""
    if region.corner is None or region.size is None:
        return region
    corner = [a + scale * (c - m) for a, c, m in zip(at, region.corner, middle, strict=True)]
    size = [scale * side for side in region.size]
    return region.model_copy(update={"corner": tuple(corner), "size": tuple(size)})


def _check_lengths(at: Grid | RandomPlaces | ListedPlaces, dimension: int) -> None:
    """Refuse vectors of another dimension before copies are made of them."""
    for key, vector in at.vectors("at."):
        if len(vector) != dimension:
            raise problem(
                f"must have {dimension} components, not {len(vector)}", key=key, value=vector
            )


def pairs_of_copies(pairs: Sequence[Pair], copies: dict[str, list[str]]) -> Iterator[Pair]:
    """Yield pairs with the names of all copies in place of that of their pattern.

    Raises
    ------
    PydanticCustomError
        A pair of a pattern with itself.
    """
    for index, pair in enumerate(pairs):
        if copies.keys().isdisjoint(pair.between):
            yield pair
            continue
        if len(set(pair.between)) == 1:
            raise problem(
                "copies touch one another as contact itself says; give it there, and what others "
                "do differently in pairs",
                key=f"contact.pairs.{index}.between",
                value=pair.between,
            )
        names = [copies.get(name, [name]) for name in pair.between]
        for two in itertools.product(*names):
            yield pair.model_copy(update={"between": two})


_VECTORS = {"places": ("x", "y", "z"), "velocities": ("vx", "vy", "vz")}
_SPINS = ("spin_x", "spin_y", "spin_z")


def _columns(file: str) -> dict[str, tuple[Any, ...]]:
    """Return the lists that the columns of a file make."""
    try:
        with Path(file).open(encoding="utf-8-sig", newline="") as lines:
            rows = list(csv.DictReader(lines, skipinitialspace=True))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        what = getattr(error, "strerror", None) or str(error)
        raise problem(f"cannot be read: {what}", key="file", value=file) from error
    heads = [head for head in rows[0] if head is not None] if rows else []
    names = (*_VECTORS["places"], *_VECTORS["velocities"], *_SPINS, "scale", "spin")
    unknown = [head for head in heads if head not in names]
    if not rows or unknown or not {"x", "y"} <= set(heads):
        what = f"column {unknown[0]!r} is not known" if unknown else "has no columns x and y"
        raise problem(f"{what}; its first line names {', '.join(names)}", key="file", value=file)

    def number(line: int, head: str) -> float:
        text = rows[line][head]
        try:
            value = float(text)
        except (TypeError, ValueError):
            value = math.nan
        if not math.isfinite(value):
            what = f"line {line + 2}: {head} must be a finite number, not {text!r}"
            raise problem(what, key="file", value=file)
        return value

    def vectors(of: tuple[str, ...]) -> tuple[tuple[float, ...], ...]:
        there = [head for head in of if head in heads]
        every = range(len(rows)) if there else ()
        return tuple(tuple(number(line, head) for head in there) for line in every)

    def numbers(head: str) -> tuple[float, ...]:
        return tuple(number(line, head) for line in range(len(rows))) if head in heads else ()

    scales = numbers("scale")
    if any(scale <= 0.0 for scale in scales):
        line = next(k for k, scale in enumerate(scales) if scale <= 0.0) + 2
        raise problem(f"line {line}: scale must be greater than 0", key="file", value=file)
    return {
        **{name: vectors(of) for name, of in _VECTORS.items()},
        "scales": scales,
        "spins": vectors(_SPINS) or numbers("spin"),
    }
