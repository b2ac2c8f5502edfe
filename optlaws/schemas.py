"""JSON Schemas of the files that optlaws writes and reads."""

from __future__ import annotations

import json
import re
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from optlaws.echo import unknown_key
from optlaws.errors import InputError

_PACKAGE = Path(__file__).resolve().parent
_REFERENCE = re.compile(r'"#/\$defs/(\w+)"')
_KINDS = (
    "law",
    "law_file",
    "solution",
    "array",
    "front",
    "proven_front",
    "fastest_move",
    "time_front",
    "cycle",
    "axes",
    "study",
    "solutions_results",
    "table_results",
    "machine_laws_results",
    "cycle_results",
    "cam_results",
    "fastest_results",
    "fronts_results",
    "loader_results",
    "certificate",
)


def json_schema(kind: str) -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of a kind of file, which needs no other file.

    Parameters
    ----------
    kind
        What the file holds, as the page of JSON formats names it: "law", "solution", "array", "front", "proven_front",
        "fastest_move", "time_front", "cycle", "axes", "study", "certificate", or the results of a job, such as
        "cycle_results".

    Raises
    ------
    InputError
        If there is no such kind.

    Examples
    --------
    >>> import optlaws
    >>> from jsonschema import Draft202012Validator
    >>> law = Draft202012Validator(optlaws.json_schema("law"))
    >>> law.is_valid(optlaws.smoothstep(3).to_dict()), law.is_valid({"kind": "polynomial"})
    (True, False)
    """
    if kind not in _KINDS:
        raise InputError(unknown_key(kind, _KINDS, "kind of file"))
    known = _formats()["$defs"]
    definitions: dict[str, Any] = {}
    missing = [kind]
    while missing:
        name = missing.pop()
        if name not in definitions:
            definitions[name] = _defined(known[name])
            missing += _REFERENCE.findall(json.dumps(definitions[name]))
    return {
        "$schema": _formats()["$schema"],
        "title": f"{kind} of optlaws",
        "$ref": f"#/$defs/{kind}",
        "$defs": definitions,
    }


def _defined(definition: dict[str, Any]) -> dict[str, Any]:
    """A definition, with the entries of the class that it names as `declared`, or of those of its `kinds`."""
    rest = dict(definition)
    if kinds := rest.pop("kinds", None):
        return {**rest, "oneOf": [_of_kind(name, kind) for name, kind in _class(kinds).kinds.items()]}
    if "declared" not in rest:
        return rest
    cls = _class(rest.pop("declared"))
    schema = cls.json_schema() if hasattr(cls, "json_schema") else _of_fields(cls)
    if "properties" not in schema:
        return {**schema, **rest}
    required = dict.fromkeys([*rest.get("required", []), *schema.get("required", [])])
    properties = {**schema["properties"], **rest.get("properties", {})}
    return {**schema, **rest, "properties": properties, "required": list(required)}


def _class(place: str) -> Any:
    module, _, name = place.rpartition(".")
    return getattr(import_module(module), name)


def _of_kind(name: str, kind: type) -> dict[str, Any]:
    """A kind of values whose fields are all written."""
    schema = _of_fields(kind)
    properties = {"kind": {"const": name}, **schema["properties"]}
    return {**schema, "properties": properties, "required": list(properties), "additionalProperties": False}


def _of_fields(cls: type) -> dict[str, Any]:
    """The schema of a class by the types of its fields, whose own classes are the definitions that name them."""
    from msgspec.json import schema_components

    named = {known.get("declared", "").rpartition(".")[2]: name for name, known in _formats()["$defs"].items()}
    _, components = schema_components([cls], schema_hook=lambda _: {"$ref": "#/$defs/law"})
    text = _REFERENCE.sub(
        lambda match: f'"#/$defs/{named.get(match[1], match[1])}"', json.dumps(components[cls.__name__])
    )
    plain: dict[str, Any] = json.loads(text)
    return {key: value for key, value in plain.items() if key not in {"title", "description"}}


@cache
def _formats() -> dict[str, Any]:
    schema: dict[str, Any] = json.loads((_PACKAGE / "files" / "formats.schema.json").read_text("utf-8"))
    return schema
