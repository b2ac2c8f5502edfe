"""JSON Schemas of the files that optlaws writes and reads."""

from __future__ import annotations

import json
import re
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.suggest import unknown_key

_PACKAGE = Path(__file__).resolve().parent
_REFERENCE = re.compile(r'"#/\$defs/(\w+)"')
#: a file of a proof alone, which has a schema of its own
_CERTIFICATE = "certificate"
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
    _CERTIFICATE,
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
    formats, proofs = _read("files", "formats"), _read("verification", "proof")
    known = {**proofs["$defs"], **formats["$defs"], _CERTIFICATE: {"oneOf": proofs["oneOf"]}}
    definitions: dict[str, Any] = {}
    missing = [kind]
    while missing:
        name = missing.pop()
        if name not in definitions:
            definitions[name] = _defined(known[name])
            missing += _REFERENCE.findall(json.dumps(definitions[name]))
    return {
        "$schema": formats["$schema"],
        "title": f"{kind} of optlaws",
        "$ref": f"#/$defs/{kind}",
        "$defs": definitions,
    }


def _defined(definition: dict[str, Any]) -> dict[str, Any]:
    """A definition, with the entries of the class that it names as `declared`."""
    if "declared" not in definition:
        return definition
    module, _, name = definition["declared"].rpartition(".")
    schema = getattr(import_module(module), name).json_schema()
    return {
        **schema,
        **{key: value for key, value in definition.items() if key != "declared"},
        "properties": {**definition.get("properties", {}), **schema.get("properties", {})},
        "required": [*definition.get("required", []), *schema.get("required", [])],
    }


@cache
def _read(room: str, name: str) -> dict[str, Any]:
    schema: dict[str, Any] = json.loads((_PACKAGE / room / f"{name}.schema.json").read_text("utf-8"))
    return schema
