"""A scenario: all that a run needs to know."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    Field,
    PrivateAttr,
    SerializerFunctionWrapHandler,
    model_serializer,
    model_validator,
)
from pydantic_core import PydanticCustomError
from typing_extensions import Self

from carom.case import case_file, overrides
from carom.case.analysis import Analysis, with_kind
from carom.case.body import AnyBody, Body, RigidBody, with_kinds
from carom.case.contact import Contact
from carom.case.default_condition import with_condition
from carom.case.description import Description, Name
from carom.case.foreign_body import ForeignEntry
from carom.case.full_stage import FullStage, full_stages
from carom.case.initial import Initial
from carom.case.load import Load
from carom.case.material import Material
from carom.case.motion import Motion
from carom.case.obstacle import Obstacle
from carom.case.output import Output, Track
from carom.case.pattern import Pattern, pairs_of_copies
from carom.case.point_mass import PointMass
from carom.case.spring import Spring
from carom.case.stage import Stage, StageOutput
from carom.case.stage_rules import check_stages
from carom.case.vibrating import check_modes
from carom.errors import naming
from carom.messages import inside, known, problem


class Scenario(Description):
    """All that a run needs to know, in SI units.

    The same object is a TOML file (`from_toml`, `to_toml`), a dictionary (`from_dict`) and, for
    the native core, JSON (`to_json`).

    Parameters
    ----------
    title
        What the plots and the results are headed with.
    dimension
        Dimension of space, 2 or 3. Vectors have as many components.
    analysis
        How the motion is computed. Of a case with stages left out: each has its own.
    output
        What is recorded.
    materials
        Materials by name.
    bodies
        Bodies, deformable or rigid. Those that patterns make come after those that are given; at
        least one of both.
    patterns
        Bodies that are there many times: on a grid, at random, or where a list says.
    obstacles
        Rigid obstacles.
    masses
        Masses at points of bodies; of all stages.
    springs
        Springs and dampers between bodies and other places; of all stages.
    loads
        Forces on bodies.
    motions
        Prescribed motion of parts of bodies.
    contact
        Contact and friction. Its `condition` is that of the dynamic stages of a case with stages.
    initial
        The state that the case starts from; None is bodies as they are drawn.
    stages
        Analyses in sequence; a case without any has the one of `analysis`. What stands above them
        holds from the first on.
    """

    title: str = ""
    dimension: Literal[2, 3] = 2
    analysis: Analysis | None = None
    output: Output = Output()
    materials: dict[Name, Material] = Field(default_factory=dict)
    bodies: Annotated[tuple[AnyBody, ...], Field(min_length=1)] = ()
    patterns: tuple[Pattern, ...] = ()
    obstacles: tuple[Obstacle, ...] = ()
    masses: tuple[PointMass, ...] = ()
    springs: tuple[Spring, ...] = ()
    loads: tuple[Load, ...] = ()
    motions: tuple[Motion, ...] = ()
    contact: Contact = Contact()
    initial: Initial | None = None
    stages: tuple[Stage, ...] = ()

    _given: dict[str, Any] = PrivateAttr(default_factory=dict)
    """Bodies and contact as they were given, where patterns have added to them."""

    @classmethod
    def from_toml(cls, path: str | Path) -> Self:
        """Read a case file.

        Raises
        ------
        InputError
            The file cannot be read or describes no scenario that can be run; the message names
            the file, the key and the value.
        """
        with naming(path):
            data = case_file.read(Path(path))
            return cls.from_dict(case_file.with_paths_from(Path(path).parent, data))

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Make a scenario of nested dictionaries and lists, laid out as the case file is."""
        return cls(**data)

    def to_toml(self, *, complete: bool = False) -> str:
        """Return the case file of this scenario.

        Parameters
        ----------
        complete
            Whether values equal to their defaults are written too, so that the file means the same
            to every version.
        """
        return case_file.write(self, complete=complete)

    def to_json(self) -> str:
        """Return the JSON that the native core reads, with every default written out.

        What a stage does not change is written out in it too.
        """
        data = self.model_dump(mode="json")
        del data["patterns"]
        if self._given:
            data["bodies"] = [body.model_dump(mode="json") for body in self.bodies]
            data["contact"] = self.contact.model_dump(mode="json")
        full = self.full_stages()
        data["output"] |= {
            "fields_every": full[0].fields_every,
            "history_every": full[0].history_every,
        }
        data |= {key: value for key, value in full[0].to_data().items() if key in data}
        data["stages"] = [stage.to_data() for stage in full] if self.stages else []
        return json.dumps(data)

    def full_stages(self) -> tuple[FullStage, ...]:
        """Return the analyses of the case in sequence, with all that goes on written out.

        A case without stages has one.
        """
        return tuple(full_stages(self))

    @property
    def end_time(self) -> float:
        """When the case ends [s]."""
        return self.full_stages()[-1].end_time

    def with_overrides(self, assignments: Iterable[str]) -> Self:
        """Return the scenario with some of its values replaced.

        Parameters
        ----------
        assignments
            Each ``KEY=VALUE``: a dotted path with list indices from 0, and a TOML value; a bare
            word counts as a string. Examples: ``analysis.end_time=3``,
            ``bodies.0.mesh.divisions=12``, ``contact.condition=midpoint``.
        """
        return self.from_dict(overrides.apply(self.model_dump(mode="json"), assignments))

    def with_values(self, values: Mapping[str, Any]) -> Self:
        """Return the scenario with some of its values replaced, given by their dotted keys."""
        return self.from_dict(overrides.with_values(self.model_dump(mode="json"), values))

    def _repr_html_(self) -> str:
        from carom.case.notebook import scenario_html  # noqa: PLC0415 (for notebooks only)

        return scenario_html(self)

    def given(self, key: str) -> Any:  # noqa: ANN401 (of any field)
        """Return the value of a field as it was given, without what patterns make."""
        return self._given.get(key, super().given(key))

    @model_serializer(mode="wrap")
    def _as_given(self, serialize: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """Write the case as it was given: patterns make the rest again."""
        plain = self.model_copy()
        plain.__dict__.update(self._given)
        data: dict[str, Any] = serialize(plain)
        if not plain.bodies:
            del data["bodies"]
        return data

    @model_validator(mode="after")
    def _patterns_make_bodies(self) -> Self:
        if not self.patterns and not self.bodies:
            raise problem("required key is missing; give bodies, or patterns of them", key="bodies")
        if not self.patterns:
            return self
        made: list[AnyBody] = []
        copies: dict[str, list[str]] = {}
        for index, pattern in enumerate(self.patterns):
            try:
                bodies = pattern.bodies(self.dimension)
            except PydanticCustomError as error:
                raise inside(error, f"patterns.{index}") from None
            copies.setdefault(pattern.body.name, []).extend(body.name for body in bodies)
            made += bodies
        pairs = tuple(pairs_of_copies(self.contact.pairs, copies))
        self._given = {"bodies": self.bodies, "contact": self.contact}
        self.__dict__["bodies"] = (*self.bodies, *made)
        self.__dict__["contact"] = self.contact.model_copy(update={"pairs": pairs})
        return self

    @model_validator(mode="after")
    def _names_are_unique(self) -> Self:
        first_use: dict[str, str] = {}
        for key, name in self._names():
            if name in first_use:
                raise problem(
                    f"name already used by {first_use[name]}; "
                    "names are unique over bodies, obstacles, springs and tracked points",
                    key=key,
                    value=name,
                )
            first_use[name] = key
        return self

    @model_validator(mode="after")
    def _shapes_and_vectors_are_of_the_dimension(self) -> Self:
        for index, body in enumerate(self.bodies):
            path, shape = f"bodies.{index}", body.mesh.dimension
            if shape not in (None, self.dimension):
                raise problem(
                    f"a {body.mesh.kind} is a body in {shape}D; set dimension = {shape} at the "
                    "top, or choose another shape",
                    key=f"{path}.mesh.kind",
                    value=body.mesh.kind,
                )
            if self.dimension == 3 and body.hypothesis != "plane-strain":
                raise problem(
                    "is of 2D bodies; leave it out in 3D",
                    key=f"{path}.hypothesis",
                    value=body.hypothesis,
                )
            if body.spin is not None and isinstance(body.spin, tuple) != (self.dimension == 3):
                form = "three components" if self.dimension == 3 else "a number"
                raise problem(
                    f"a spin in {self.dimension}D is {form}", key=f"{path}.spin", value=body.spin
                )
        for key, vector in self.vectors():
            if len(vector) != self.dimension:
                raise problem(
                    f"must have {self.dimension} components, not {len(vector)}",
                    key=key,
                    value=vector,
                )
        return self

    @model_validator(mode="after")
    def _materials_exist(self) -> Self:
        for index, body in enumerate(self.bodies):
            if isinstance(body, RigidBody | ForeignEntry):
                continue
            path = f"bodies.{index}"
            _require(body.material, self.materials, what="material", key=f"{path}.material")
            for number, region in enumerate(body.regions):
                key = f"{path}.regions.{number}.material"
                _require(region.material, self.materials, what="material", key=key)
        return self

    @model_validator(mode="after")
    def _some_bodies_start_as_drawn(self) -> Self:
        # What is read of the nodes of another state may be no more than a part of it.
        if self.initial is not None and any(body.kind == "reduced" for body in self.bodies):
            raise problem("a case with a reduced body starts as drawn; leave it out", key="initial")
        if self.initial is not None and any(body.kind == "foreign" for body in self.bodies):
            raise problem(
                "a case with a body of another code starts as drawn; leave it out", key="initial"
            )
        return self

    @model_validator(mode="before")
    @classmethod
    def _kind_of_analysis(cls, data: object) -> object:
        """Take an analysis that names no kind for dynamic, and a condition that suits it."""
        return with_condition(with_kinds(with_kind(data)))

    @model_validator(mode="after")
    def _driven_bodies_exist(self) -> Self:
        bodies = [body.name for body in self.bodies]
        parts: list[tuple[str, Scenario | Stage]] = [("", self)]
        parts += [(f"stages.{index}.", stage) for index, stage in enumerate(self.stages)]
        for path, part in parts:
            for index, load in enumerate(part.loads):
                _require(load.body, bodies, what="body", key=f"{path}loads.{index}.body")
            for index, motion in enumerate(part.motions):
                _require(motion.body, bodies, what="body", key=f"{path}motions.{index}.body")
        for index, entry in enumerate(() if self.initial is None else self.initial.displacements):
            key = f"initial.displacements.{index}.body"
            _require(entry.body, bodies, what="body", key=key)
        return self

    @model_validator(mode="after")
    def _tracked_bodies_exist(self) -> Self:
        bodies = [body.name for body in self.bodies]
        for index, track in enumerate(self.output.track):
            _require(track.body, bodies, what="body", key=f"output.track.{index}.body")
        return self

    @model_validator(mode="after")
    def _springs_and_masses_have_places(self) -> Self:
        bodies = [body.name for body in self.bodies]
        for index, mass in enumerate(self.masses):
            _require(mass.body, bodies, what="body", key=f"masses.{index}.body")
        obstacles = [obstacle.name for obstacle in self.obstacles]
        for index, spring in enumerate(self.springs):
            key = f"springs.{index}.between"
            for end, place in enumerate(spring.between):
                if place.body is not None:
                    _require(place.body, bodies, what="body", key=f"{key}.{end}.body")
                if place.obstacle is not None:
                    _require(
                        place.obstacle, obstacles, what="obstacle", key=f"{key}.{end}.obstacle"
                    )
            if all(place.body is None for place in spring.between):
                raise problem("neither place is of a body; attach one of them to a body", key=key)
        return self

    @model_validator(mode="after")
    def _pairs_exist_once(self) -> Self:
        obstacles = {obstacle.name for obstacle in self.obstacles}
        touch_themselves = {
            body.name
            for body in self.bodies
            if isinstance(body, Body | ForeignEntry) and body.self_contact is not False
        }
        names = [body.name for body in self.bodies] + sorted(obstacles)
        first_use: dict[frozenset[str], str] = {}
        for index, pair in enumerate(self.contact.pairs):
            key = f"contact.pairs.{index}.between"
            for name in pair.between:
                _require(name, names, what="body or obstacle", key=key)
            if obstacles.issuperset(pair.between):
                raise problem("two obstacles never touch; name a body", key=key, value=pair.between)
            two = frozenset(pair.between)
            if len(two) == 1 and two.isdisjoint(touch_themselves):
                raise problem(
                    "must be two different names, as the body has self_contact = false",
                    key=key,
                    value=pair.between,
                )
            if two in first_use:
                raise problem(
                    f"pair already given by {first_use[two]}", key=key, value=pair.between
                )
            first_use[two] = key
        return self

    @model_validator(mode="after")
    def _stages_go_together(self) -> Self:
        check_stages(self)
        return self

    @model_validator(mode="after")
    def _energy_has_modes(self) -> Self:
        check_modes(self)
        return self

    @model_validator(mode="after")
    def _records_no_finer_than_steps(self) -> Self:
        full = self.full_stages()
        least = min(stage.analysis.time_step for stage in full)
        _refuse_finer(self.output, least, "output")
        for stage, own in zip(full, self.stages, strict=False):
            if own.output is not None:
                _refuse_finer(own.output, stage.analysis.time_step, f"{stage.key}output")
        return self

    def _names(self) -> Iterator[tuple[str, str]]:
        """Yield every name with the dotted path of where it is given."""
        groups: dict[str, tuple[AnyBody | Obstacle | Spring | Track, ...]] = {
            "bodies": self.bodies,
            "obstacles": self.obstacles,
            "springs": self.springs,
            "output.track": self.output.track,
        }
        for group, members in groups.items():
            for index, member in enumerate(members):
                yield f"{group}.{index}.name", member.name


def _refuse_finer(output: Output | StageOutput, step: float, key: str) -> None:
    """Refuse to record more often than there are steps of so many seconds."""
    for name in ("fields_every", "history_every", "checkpoint_every"):
        every = getattr(output, name, None)
        if every is not None and every < step:
            raise problem(
                f"must be at least one analysis.time_step ({step:g} s)",
                key=f"{key}.{name}",
                value=every,
            )


def _require(name: str, names: Iterable[str], *, what: str, key: str) -> None:
    """Refuse a name that refers to nothing."""
    names = list(names)
    if name not in names:
        raise problem(f"no such {what}; {known(name, names)}", key=key, value=name)
