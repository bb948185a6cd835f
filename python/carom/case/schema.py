"""The case file as a JSON Schema, by which editors complete and check it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from pydantic.fields import FieldInfo
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core import core_schema

from carom.case.analysis import Dynamic
from carom.case.body import Body
from carom.case.description import PER_DIMENSION, InPlane, InSpace, asked_of
from carom.case.docstrings import documented, summary
from carom.case.mesh import MeshFile
from carom.case.scenario import Scenario

DRAFT = "http://json-schema.org/draft-07/schema#"
"""The draft that editors of TOML know."""

KIND_UNSAID = (Body, Dynamic, MeshFile)
"""Classes of which a table may be without saying its kind."""

_LENGTHS = ((PER_DIMENSION, (2, 3)), (InPlane, (2, 2)), (InSpace, (3, 3)))


def case_file_schema() -> dict[str, Any]:
    """Return the JSON Schema of the case file.

    It knows keys, types, kinds, ranges and what they mean. What joins several keys, such as the
    names that refer to one another, only carom itself checks.
    """
    schema = Scenario.model_json_schema(
        ref_template="#/definitions/{model}", schema_generator=_CaseFile
    )
    definitions = schema.pop("$defs")
    said = {
        reference.rpartition("/")[2]
        for union in list(_discriminated([schema, definitions]))
        for reference in union.pop("discriminator")["mapping"].values()
    }
    for name in sorted(said - {kind.__name__ for kind in KIND_UNSAID}):
        definitions[name]["required"] = ["kind", *definitions[name].get("required", [])]
    # Either an analysis, or stages that have one each.
    schema["oneOf"] = [{"required": ["analysis"]}, {"required": ["stages"]}]
    return {"$schema": DRAFT, "title": "carom case file", **schema, "definitions": definitions}


def _discriminated(part: Any) -> Iterator[dict[str, Any]]:  # noqa: ANN401 (any part of a schema)
    """Yield the schemas within this one that choose by kind."""
    for member in part.values() if isinstance(part, dict) else part:
        if isinstance(member, dict | list):
            yield from _discriminated(member)
    if isinstance(part, dict) and "mapping" in part.get("discriminator", {}):
        yield part


class _CaseFile(GenerateJsonSchema):
    """Makes the schema of what a file may say, with the docstrings as descriptions."""

    def model_schema(self, schema: core_schema.ModelSchema) -> JsonSchemaValue:
        model = schema["cls"]
        made = super().model_schema(schema)
        made.pop("title", None)
        made["description"] = summary(model)
        said = {"kind": "Kind of this table.", **documented(model)}
        for name, entry in made["properties"].items():
            made["properties"][name] = _described(entry, model.model_fields[name], said[name])
        return made

    def nullable_schema(self, schema: core_schema.NullableSchema) -> JsonSchemaValue:
        """Leave None out: TOML has no word for it."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: core_schema.WithDefaultSchema) -> JsonSchemaValue:
        """Leave out what no editor would write: a table of defaults, an empty list."""
        made = super().default_schema(schema)
        if isinstance(made.get("default"), dict | list | None):
            made.pop("default", None)
        return made


def _described(entry: JsonSchemaValue, field: FieldInfo, text: str) -> JsonSchemaValue:
    """Return the schema of a key with what it means, and the length of vectors."""
    entry = {key: value for key, value in entry.items() if key != "title"}
    if "$ref" in entry:  # what stands beside a reference counts for nothing in this draft
        entry = {"allOf": [{"$ref": entry.pop("$ref")}], **entry}
    asked = list(asked_of(field))
    for marker, (least, most) in _LENGTHS:
        if any(one is marker for one in asked):
            for form in (entry, *entry.get("anyOf", ())):
                if form.get("type") == "array":
                    # What is asked of one member is asked of every member of an array of vectors.
                    vector = form["items"] if form["items"].get("type") == "array" else form
                    vector |= {"minItems": least, "maxItems": most}
    return {"description": text.replace("``", "").replace("`", ""), **entry}
