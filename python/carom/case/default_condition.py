"""The contact condition of a case that names none."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

from carom.case.contact import Condition, Contact

_Given = TypeVar("_Given")


def with_condition(data: object) -> object:
    """Return a table of the case file with the condition that suits its analyses, if it names none.

    Load steps rule the gap. With `Theta` massless contact would take energy, which the conserving
    scheme alone gives back: there the motion is ruled. So it is where another run led, whose load
    steps had weight at nodes that would have none: what rested there goes on resting.
    """
    if not isinstance(data, Mapping):
        return data
    stages = data.get("stages", ())
    stages = stages if isinstance(stages, list | tuple) else ()
    analyses = [_of(stage, "analysis") for stage in stages]
    analyses.append(data.get("analysis"))
    if _of(analyses[-1], "kind") == "static":
        return {**data, "contact": with_default("gap", data.get("contact", {}))}
    has_theta = any(_of(_of(analysis, "scheme"), "kind") == "theta" for analysis in analyses)
    if has_theta or _of(data.get("initial"), "result") is not None:
        return {**data, "contact": with_default("midpoint", data.get("contact", {}))}
    return data


def with_default(condition: Condition, contact: _Given) -> _Given | Any:  # noqa: ANN401 (as given)
    """Return a law of contact in which this is the condition, unless it names one itself."""
    if isinstance(contact, Contact) and "condition" not in contact.model_fields_set:
        return contact.model_copy(update={"condition": condition})
    if isinstance(contact, Mapping) and "condition" not in contact:
        return {**contact, "condition": condition}
    return contact


def _of(given: object, name: str) -> Any:  # noqa: ANN401 (checked where it is used)
    """Return what a table, or an object, has under a name; None if it has nothing."""
    return given.get(name) if isinstance(given, Mapping) else getattr(given, name, None)
