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

from optlaws.cli.app import head_of
from optlaws.entries.declared import Declared, entries_of
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


#: of parameters by their annotations
_TYPES = {"Quantity": str, "str": str, "float": float, "int": Whole}
#: how long a motion takes is its time in older scripts
_OLDER = {"duration": ("--time",)}
_PARAMETERS = "Parameters\n----------\n"
_PARAMETER = re.compile(r"^(\w[\w, ]*)\n((?: +.*\n?)+)", re.MULTILINE)


def options(
    source: Callable[..., Any], *names: str, group: str | None = None, **changed: Mapping[str, Any]
) -> dict[str, Option]:
    """The options that give parameters of a function, or entries of a declared value: by its sentences and defaults.

    Parameters
    ----------
    source
        The function, or the class.
    names
        Of parameters whose options have their names.
    group
        What heads them in the help of a command.
    changed
        By name of a parameter: what of `Option` is another.

    Examples
    --------
    >>> from optlaws import fastest
    >>> stroke = options(fastest, "stroke")["stroke"]
    >>> stroke.name, stroke.about, stroke.signed
    ('--stroke', 'How far, above 0: "100 mm" or "90 deg".', True)
    """
    sentences, parameters = _sentences(source), inspect.signature(source).parameters
    known = {}
    for name in (*names, *changed):
        parameter = parameters[name]
        annotation = str(parameter.annotation).removesuffix(" | None")
        about: dict[str, Any] = {
            "name": f"--{name.replace('_', '-')}",
            "type": _TYPES.get(annotation),
            "about": sentences.get(name, ""),
            "default": None if parameter.default is inspect.Parameter.empty else parameter.default,
            "signed": annotation == "Quantity",
            "also": _OLDER.get(name, ()),
            "group": group,
        }
        known[name] = Option(**{**about, **changed.get(name, {})})
    return known


def _sentences(source: Callable[..., Any]) -> dict[str, str]:
    """What a declaration or a docstring says of each parameter."""
    if isinstance(source, type) and issubclass(source, Declared):
        return {name: each.about for name, each in entries_of(source).items()}
    section = (inspect.getdoc(source) or "").partition(_PARAMETERS)[2].partition("\n\n")[0]
    return {name: " ".join(text.split()) for names, text in _PARAMETER.findall(section) for name in names.split(", ")}


def without_body(place: str) -> Callable[..., Any]:
    """A function of a module without its body: to import this may take longer than a command does.

    Examples
    --------
    >>> options(without_body("optlaws.cycles.moves.timed_moves:fastest"), "stroke")["stroke"].signed
    True
    """
    module, _, name = place.partition(":")
    file = Path(__file__).parents[1].joinpath(*module.split(".")[1:]).with_suffix(".py")
    signature, text = head_of(file, name)
    namespace: dict[str, Any] = {}
    program = f'from __future__ import annotations\ndef {name}({signature}"""{text}"""'
    exec(program, namespace)  # noqa: S102 - the text is the package's own
    function: Callable[..., Any] = namespace[name]
    return function


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
