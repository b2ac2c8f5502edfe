"""Options of commands: those of a function or a declared value of the library by its own sentences, files, --json."""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter, Token

from optlaws.entries import value_types
from optlaws.entries.declared import Declared, Entry, entries_of
from optlaws.entries.value_types import ValueType
from optlaws.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Command = Callable[..., None]


def _whole(_: object, tokens: Sequence[Token]) -> int:
    # the parser itself would cut 2.5 to 2
    return int(tokens[0].value)


_PICTURES = (".png", ".svg")


def check_file(_: object, file: Path | None) -> None:
    """Refuse, before anything is computed, a file that could not be written."""
    from optlaws.files.writing import check_place

    if file is not None:
        check_place(file)


def _check_picture(_: object, file: Path | None) -> None:
    if file is not None and file.suffix not in _PICTURES:
        raise InputError(f"--plot takes a file name that ends in {' or '.join(_PICTURES)}, got {file}")
    check_file(_, file)


Whole = Annotated[int, Parameter(converter=_whole)]
AsJson = Annotated[bool, Parameter(name="--json", help="Print one line of JSON on stdout and nothing else.")]
#: a quantity that may be below 0, which is the library's to take or to refuse
Signed = Annotated[str | None, Parameter(allow_leading_hyphen=True)]
#: where a command writes what it has found, and where it draws it
Written = Annotated[Path | None, Parameter(validator=check_file)]
Plot = Annotated[Path | None, Parameter(name="--plot", validator=_check_picture)]


@dataclass(frozen=True)
class Option:
    """An option; `read` converts what is typed, which may begin with a minus where `signed`; `also` are older names.

    The default `...` makes the option's value compulsory; `group` heads options that belong together in the help.
    """

    name: str
    type: Any
    about: str
    default: Any = None
    read: Callable[[Any], Any] | None = None
    signed: bool = False
    shown: bool = True
    also: tuple[str, ...] = ()
    group: str | None = None

    @property
    def keyword(self) -> str:
        """The name of the command's parameter."""
        return self.name.removeprefix("--").replace("-", "_")

    @property
    def parameter(self) -> inspect.Parameter:
        """The parameter of a command."""
        needed = self.default is ...
        kind = self.type if needed or self.default is not None else self.type | None
        heading: dict[str, Any] = {} if self.group is None else {"group": self.group}
        how = Parameter(
            name=(self.name, *self.also), help=self.about, show=self.shown, allow_leading_hyphen=self.signed, **heading
        )
        return inspect.Parameter(
            self.keyword,
            inspect.Parameter.KEYWORD_ONLY,
            default=inspect.Parameter.empty if needed else self.default,
            annotation=Annotated[kind, how],
        )

    def value(self, typed: Any) -> Any:
        """The value of the option, None where none is typed and there is no default."""
        return typed if typed is None or self.read is None else self.read(typed)


#: types of options by those of entries, and by the annotations of parameters
_TYPES: dict[type[ValueType] | str, Any] = {
    value_types.Choice: str,
    value_types.Measured: str,
    value_types.Number: float,
    value_types.Switch: bool,
    value_types.Text: str,
    value_types.Whole: Whole,
    "Quantity": str,
    "float": float,
    "int": Whole,
    "str": str,
}
#: how long a motion takes is its time in older scripts
_OLDER = {"duration": ("--time",)}
_PARAMETERS = "Parameters\n----------\n"
_PARAMETER = re.compile(r"^(\w[\w, ]*)\n((?: +.*\n?)+)", re.MULTILINE)


def options(
    source: Mapping[str, Entry] | Callable[..., Any],
    *names: str,
    group: str | None = None,
    **changed: Mapping[str, Any],
) -> dict[str, Option]:
    """The options that give entries of a table or a declared value, or parameters of a function, with their sentences.

    Parameters
    ----------
    source
        The entries by their names, or the class that declares them, or a function with a docstring.
    names
        Of the entries or parameters whose options have their names.
    group
        What heads them in the help of a command.
    changed
        By name of an entry or parameter: what of `Option` is another.

    Examples
    --------
    >>> from optlaws import fastest
    >>> stroke = options(fastest, "stroke")["stroke"]
    >>> stroke.name, stroke.about, stroke.signed
    ('--stroke', 'How far, above 0: "100 mm" or "90 deg".', True)
    """
    known = {}
    for name in (*names, *changed):
        usual = {"name": f"--{name.replace('_', '-')}", "also": _OLDER.get(name, ()), "group": group}
        known[name] = Option(**{**usual, **_described(source, name), **changed.get(name, {})})
    return known


def _described(source: Any, name: str) -> dict[str, Any]:
    """Sentence, type and default of an entry or a parameter, and whether it is a quantity, which may be below 0."""
    if isinstance(source, type) and issubclass(source, Declared):
        source = entries_of(source)
    if isinstance(source, Mapping):
        each = source[name]
        kind, signed = _TYPES.get(type(each.type)), isinstance(each.type, value_types.Measured)
        return {"about": each.about, "type": kind, "default": each.plain_default, "signed": signed}
    parameter = inspect.signature(source).parameters[name]
    section = (inspect.getdoc(source) or "").partition(_PARAMETERS)[2].partition("\n\n")[0]
    about = next((text for several, text in _PARAMETER.findall(section) if name in several.split(", ")), "")
    annotation = str(parameter.annotation).removesuffix(" | None")
    default = None if parameter.default is inspect.Parameter.empty else parameter.default
    signed = annotation == "Quantity"
    return {"about": " ".join(about.split()), "type": _TYPES.get(annotation), "default": default, "signed": signed}


def takes(**groups: Mapping[str, Option]) -> Callable[[Command], Command]:
    """Give a command options in place of parameters, each of which takes the values of its options as a table."""

    def decorated(command: Command) -> Command:
        parameters: list[inspect.Parameter] = []
        for name, parameter in inspect.signature(command).parameters.items():
            parameters += [each.parameter for each in groups[name].values()] if name in groups else [parameter]

        @wraps(command)
        def called(*arguments: Any, **values: Any) -> None:
            tables = {
                group: {name: each.value(values.pop(each.keyword, each.default)) for name, each in table.items()}
                for group, table in groups.items()
            }
            command(*arguments, **values, **tables)

        called.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        called.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
        return called

    return decorated


def given(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values that are given: those of options that have been typed, and defaults.

    Examples
    --------
    >>> given({"stroke": "35 mm", "duration": None})
    {'stroke': '35 mm'}
    """
    return {name: value for name, value in values.items() if value is not None}


def save(file: Path | None, data: Mapping[str, Any]) -> None:
    """Write the file of --output, where there is one, with the name of its author program."""
    from optlaws.files.writing import MARK, write

    if file is not None:
        write(file, json.dumps({"about": MARK, **data}, indent=1) + "\n")


def save_picture(file: Path | None, value: Any, **style: Any) -> None:
    """Draw the picture of --plot into its file, where there is one."""
    if file is not None:
        from optlaws.plots.style import plot_style

        with plot_style():
            save_figure(file, value.plot(**style)[0].get_figure(root=True))


def save_figure(file: Path, figure: Figure) -> None:
    """Write a figure into the file of --plot, in the format of the file's ending."""
    from optlaws.files.writing import write
    from optlaws.plots.style import rendered

    write(file, rendered(figure, file.suffix[1:]))
