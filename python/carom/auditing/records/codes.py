"""The codes of bodies that no file holds the law of, as they are handed to an audit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from carom.auditing.bodies.code import Code
from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.messages import known


def codes_of(scenario: Scenario, given: Sequence[Code]) -> Mapping[str, Code]:
    """Return the codes of bodies of a case that are handed over, by name.

    Raises
    ------
    InputError
        Something is no such body, or of none of the case.
    """
    names = [body.name for body in scenario.bodies if body.kind == "foreign"]
    for one in given:
        if not hasattr(one, "energy_at"):
            kind = type(one).__name__
            raise InputError(f"bodies: a {kind} is no body of another code; give carom.ForeignBody")
        if one.name not in names:
            raise InputError(
                f"bodies: {one.name!r} is of no other code here; {known(one.name, names)}"
            )
    return {one.name: one for one in given}
