"""The contract with users: public names with their signatures, options of commands, jobs with their entries.

frozen.json is that of the last release, whose commit has it: nobody edits it. `python -m tests.contracts.frozen` writes
it anew for the next one. tests/contracts/test_frozen.py compares it with what is now.
"""

import inspect
import json
import re
import subprocess
from collections.abc import Iterator
from enum import EnumType
from pathlib import Path
from tempfile import TemporaryDirectory
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin
from unittest.mock import patch

from cyclopts import App

import optlaws
from optlaws.results import Results
from tests.internals.cli import app_of_app as app
from tests.internals.entries import Kinded, entries_of
from tests.internals.jobs import JOBS, ProblemFile, do

FROZEN = Path(__file__).with_name("frozen.json")
Table = dict[str, dict[str, str]]


class Asked(Exception):  # noqa: N818 - not an error: it carries what a job would read
    """Raised in place of reading a problem file."""

    def __init__(self, spec: Any) -> None:
        super().__init__(spec)
        self.spec = spec


def text_of(value: object) -> str:
    """A default or a type as text that names no module and no address."""
    return re.sub(r" at 0x[0-9a-f]+", "", re.sub(r"\b(?:[A-Za-z_]\w*\.)+(?=[A-Za-z_])", "", repr(value)))


def signature(function: Any) -> dict[str, str]:
    """Parameters with their kinds and defaults."""
    try:
        signature = inspect.signature(function).parameters.values()
    except ValueError:
        return {}  # exceptions made of a message alone
    return {
        one.name: one.kind.description + ("" if one.default is one.empty else f" = {text_of(one.default)}")
        for one in signature
    }


def public_names() -> Table:
    """Every public callable and every public method of a public class, with its parameters."""
    table: Table = {}
    for name in vars(optlaws)["__all__"]:
        value = getattr(optlaws, name)
        table[name] = (
            signature(value)
            if callable(value) and not isinstance(value, EnumType) and hasattr(value, "__name__")
            else {}
        )
        if inspect.isclass(value):
            own = {
                attribute for base in value.__mro__ if base.__module__.startswith("optlaws") for attribute in vars(base)
            }
            for attribute in sorted(attribute for attribute in own if not attribute.startswith("_")):
                member = getattr(value, attribute)
                table[f"{name}.{attribute}"] = (
                    signature(member) if inspect.isroutine(member) and callable(member) else {}
                )
    return table


def commands() -> Table:
    """Every command with its options: their names, types and defaults."""
    return {name: dict(options(app[name])) for name in app if not name.startswith("-")}


def options(command: App) -> Iterator[tuple[str, str]]:
    """The options of one command."""
    for argument in command.assemble_argument_collection():
        if argument.children:
            continue  # a group of options, each of which follows
        default = argument.field_info.default
        shown = "" if default is inspect.Parameter.empty else f" = {text_of(default)}"
        names = [name for name in argument.names if not name.startswith(("--no-", "--empty-"))]
        yield " ".join(names), kind_of(plain(argument.hint)) + shown


def plain(hint: Any) -> Any:
    """A type without what is annotated to it."""
    return plain(get_args(hint)[0]) if get_origin(hint) is Annotated else hint


def jobs() -> Table:
    """Every job with the entries of its problem file: `part.name` in a part, `part[].name` in a list of them."""
    return {name: dict(entries(spec_of(name), "")) for name in JOBS}


def spec_of(job: str) -> Any:
    """What a job reads its problem file as."""

    def stop(cls: type[ProblemFile], *_: object) -> None:
        raise Asked(cls)

    with patch.object(ProblemFile, "read", classmethod(stop)), TemporaryDirectory() as folder:
        file = Path(folder, "problem.toml")
        file.write_text(f'job = "{job}"\n', "utf-8")
        try:
            do(job, Results(file))
        except Asked as asked:
            return asked.spec
    raise AssertionError(f"the job {job!r} reads no problem file")


def entries(spec: Any, where: str) -> Iterator[tuple[str, str]]:
    """Entries of a declared value, or of any of its kinds, or of a table, below one, each with its type and default."""
    if hasattr(spec, "entries"):
        # of a table, which has what is given and no more
        for each in spec.entries.values():
            yield f"{where}{each.name}", f"{kind_of_value(each.type)} | None = None"
        return
    kinds = spec.kinds() if issubclass(spec, Kinded) and not spec.kind else {}
    if kinds:
        yield f"{where}kind", f"Literal[{', '.join(map(repr, kinds))}]"
    for kind in kinds.values() or [spec]:
        for each in entries_of(kind).values():
            usual = "" if each.needed and not kinds else f" | None = {text_of(each.plain_default)}"
            yield f"{where}{each.name}", kind_of_value(each.type) + usual
            for inner, suffix in tables_of(each.type):
                yield from entries(inner, f"{where}{each.name}{suffix}.")


KINDS = {"Text": "str", "Measured": "str", "Switch": "bool", "Whole": "int", "Number": "float", "ValueOf": "table"}
KINDS |= {"ProblemTable": "table"}
PARTED = {"Together", "Either", "TableOf", "Listed", "Table", "Choice", "InSI", "ReadBy"}


def type_name(values: Any) -> str:
    """The name of a type of values, or of the one that it specialises."""
    named = (base.__name__ for base in type(values).__mro__ if base.__name__ in PARTED | KINDS.keys())
    return next(named, "ReadBy")


def kind_of_value(values: Any) -> str:
    """What the values of an entry are, as types of plain data."""
    name = type_name(values)
    if name in {"Together", "Either"}:
        parts = " | ".join(dict.fromkeys(map(kind_of_value, values.of)))
        return parts if name == "Either" else f"list[{parts}]"
    if name == "TableOf":
        parts = " | ".join(dict.fromkeys(kind_of_value(each.type) for each in values.entries.values()))
        return f"dict[str, {parts}]"
    if name in {"Listed", "Table"}:
        return f"{'list[' if name == 'Listed' else 'dict[str, '}{kind_of_value(values.of)}]"
    if name == "Choice":
        return f"Literal[{', '.join(map(repr, values.names))}]"
    table = "dict[str, Any]" if values.schema().get("type") == "object" else "Any"
    return {**KINDS, "InSI": "str | float", "ReadBy": table}[name]


def tables_of(values: Any) -> Iterator[tuple[Any, str]]:
    """Declared values in the type of an entry, and how they are addressed."""
    name = type_name(values)
    if name == "ProblemTable":
        yield values, ""
    elif name == "ValueOf":
        yield values.of, ""
    elif name in {"Listed", "Table"}:
        suffix = "[]" if name == "Listed" else ".*"
        yield from ((inner, suffix + deeper) for inner, deeper in tables_of(values.of))
    elif name == "Either":
        for part in values.of:
            yield from tables_of(part)


def kind_of(hint: Any) -> str:
    """A type in words."""
    origin, parts = get_origin(hint), get_args(hint)
    if origin in {Union, UnionType}:
        return " | ".join(map(kind_of, parts))
    if origin is Annotated:
        return kind_of(parts[0])
    if origin in {list, dict, tuple}:
        return f"{origin.__name__}[{', '.join(map(kind_of, parts))}]"
    return "None" if hint is NoneType else hint.__name__ if isinstance(hint, type) else text_of(hint)


def contract() -> dict[str, Table]:
    """All of it."""
    return {"public names": public_names(), "commands": commands(), "jobs": jobs()}


def of_release() -> str | None:
    """The contract in the commit of the last release; None where its history is not at hand."""
    commit = _git("log", "-1", "--format=%H", "--grep=^Release [0-9.]*$").strip()
    return _git("show", f"{commit}:tests/contracts/{FROZEN.name}") if commit else None


def _git(*arguments: str) -> str:
    command = ["git", *arguments]
    return subprocess.run(command, cwd=FROZEN.parent, capture_output=True, text=True, check=False).stdout


def text_of_contract() -> str:
    """All of it as the file has it."""
    return json.dumps(contract(), indent=1, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    FROZEN.write_text(text_of_contract(), "utf-8")
