"""The tables of docs/reference/command-line.md, made from what the commands declare of their arguments and options.

Each has its mark in the page: `<!-- options of NAME -->`.
"""

from inspect import Parameter
from itertools import groupby
from typing import Any

from optlaws.cli.app import app

#: commands that take the options of another, which stand there
SHARED = {"front": "solve"}
#: of options that need no heading of their own
_PLAIN = {"Arguments", "Parameters"}


def option_tables(command: str) -> str:
    """The arguments and options of a command, those of each group as a table of Markdown below its heading."""
    there = [_row(each) for each in _arguments(SHARED[command])] if command in SHARED else []
    groups = [(_heading(each), each) for each in _arguments(command) if _row(each) not in there]
    tables = []
    for heading, rows in groupby(sorted(groups, key=lambda group: group[0]), key=lambda group: group[0]):
        table = ["| Argument | Meaning |", "|---|---|", *(_row(each) for _, each in rows)]
        tables.append("\n".join([*([f"{heading}:", ""] if heading else []), *table]))
    return "\n\n".join(tables)


def _arguments(command: str) -> list[Any]:
    return [each for each in app[command].assemble_argument_collection(parse_docstring=True) if each.show]


def _heading(argument: Any) -> str:
    """What stands above an argument in the help, unless it is of those that come first."""
    return next((str(group.name) for group in argument.parameter.group or () if group.name not in _PLAIN), "")


def _row(argument: Any) -> str:
    names = [name for name in argument.names if not name.startswith(("--no-", "--empty-")) or name == "--no-browser"]
    if argument.field_info.kind is Parameter.POSITIONAL_OR_KEYWORD:
        names = [argument.name.removeprefix("--").upper()]
    text = " ".join((argument.parameter.help or "").split())
    default = argument.field_info.default
    usual = f" `{default}` unless given." if isinstance(default, str | int | float) and default is not False else ""
    among = f" One of {', '.join(f'`{each}`' for each in choices)}." if (choices := argument.get_choices()) else ""
    return f"| {', '.join(f'`{name}`' for name in names)} | {text}{among}{usual} |"
