"""JSON Schemas of the files that optlaws writes and reads."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.suggest import unknown_key

_PACKAGE = Path(__file__).resolve().parent
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
    declared = {"cycle": _cycle()} if kind in {"cycle", "axes"} else {}
    definitions = {**proofs["$defs"], **formats["$defs"], **declared, _CERTIFICATE: {"oneOf": proofs["oneOf"]}}
    return {
        "$schema": formats["$schema"],
        "title": f"{kind} of optlaws",
        "$ref": f"#/$defs/{kind}",
        "$defs": definitions,
    }


def _cycle() -> dict[str, Any]:
    """The schema of a cycle, whose laws are looked for again when it is read, from the entries that it declares."""
    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.interchange import FORMAT

    schema = Cycle.json_schema()
    more = {"format": {"const": FORMAT}, "about": {"$ref": "#/$defs/about"}}
    return {**schema, "properties": {**more, **schema["properties"]}, "required": ["format", *schema["required"]]}


@cache
def _read(room: str, name: str) -> dict[str, Any]:
    schema: dict[str, Any] = json.loads((_PACKAGE / room / f"{name}.schema.json").read_text("utf-8"))
    return schema
