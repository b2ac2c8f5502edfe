"""Options of commands: those of functions and declared values of the library by their own sentences, files, --json."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from functools import wraps
from keyword import iskeyword
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Parameter, Token

from optlaws.cli.app import head_of
from optlaws.cli.show import busy
from optlaws.entries.declared import Declared, entries_of
from optlaws.errors import InputError

Command = Callable[..., Any]


def _whole(_: object, tokens: Sequence[Token]) -> int:
    # the parser itself would cut 2.5 to 2
    return int(tokens[0].value)


def _signed(_: object, tokens: Sequence[Token]) -> str:
    token = tokens[0]
    if token.value.startswith("--"):
        raise InputError(f"none is given, as {token.value} follows")
    return token.value


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
#: a quantity that may be below 0, which is the library's to take or to refuse
Signed = Annotated[str | None, Parameter(allow_leading_hyphen=True, converter=_signed)]
#: where a command writes what it has found, and where it draws it
Written = Annotated[Path | None, Parameter(validator=check_file)]
_JSON = "Print one line of JSON on stdout and nothing else."


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
        name = self.name.removeprefix("--").replace("-", "_")
        return f"{name}_" if iskeyword(name) else name

    @property
    def parameter(self) -> inspect.Parameter:
        """The parameter of a command."""
        needed = self.default is ...
        kind = self.type if needed or self.default is not None else self.type | None
        more: dict[str, Any] = {} if self.group is None else {"group": self.group}
        if self.keyword == "plot":
            more["validator"] = _check_picture
        how = Parameter(
            name=(self.name, *self.also), help=self.about, show=self.shown, allow_leading_hyphen=self.signed, **more
        )
        default = inspect.Parameter.empty if needed else self.default
        hint: Any = Annotated[kind, how]
        return inspect.Parameter(self.keyword, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=hint)

    def value(self, typed: Any) -> Any:
        """The value of the option, None where none is typed and there is no default."""
        return typed if typed is None or self.read is None else self.read(typed)


class Options(dict[str, Option]):
    """The options that a command takes as one table."""

    def values_of(self, typed: Mapping[str, Any]) -> dict[str, Any]:
        """The table of what was typed, by keywords."""
        return {name: each.value(typed[each.keyword]) for name, each in self.items()}


#: of parameters by their annotations
_QUANTITIES = dict.fromkeys(("Quantity", "NumberOrQuantity"), str)
_TYPES: dict[str, Any] = {**_QUANTITIES, "str": str, "float": float, "int": Whole}
#: how long a motion takes is its time in older scripts
_OLDER = {"duration": ("--time",)}
_PARAMETERS = "Parameters\n----------\n"
_PARAMETER = re.compile(r"^(\w[\w, ]*)\n((?: +.*\n?)+)", re.MULTILINE)


def options(
    source: Callable[..., Any] | str, *names: str, group: str | None = None, **changed: Mapping[str, Any]
) -> Options:
    """The options that give parameters of a function, or entries of a declared value: by its sentences and defaults.

    A function is given by its place, for to import its module may take longer than a command does. By the name of a
    parameter stands what of its `Option` is `changed`.

    >>> stroke = options("optlaws.cycles.moves.timed_moves:fastest", "stroke")["stroke"]
    >>> stroke.name, stroke.about, stroke.signed
    ('--stroke', 'How far, above 0: "100 mm" or "90 deg".', True)
    """
    parameters, text = _head(source) if isinstance(source, str) else _of_object(source)
    sentences = _sentences(text)
    if isinstance(source, type) and issubclass(source, Declared):
        sentences = {name: each.about for name, each in entries_of(source).items()}
    known = Options()
    for name in (*names, *changed):
        annotation, default = parameters[name]
        about: dict[str, Any] = {
            "name": f"--{name.replace('_', '-')}",
            "type": _TYPES.get(annotation),
            "about": sentences.get(name, ""),
            "default": default,
            "signed": annotation in _QUANTITIES,
            "also": _OLDER.get(name, ()),
            "group": group,
        }
        known[name] = Option(**{**about, **changed.get(name, {})})
    return known


#: annotation, without "or None", and default of each parameter
_Parameters = dict[str, tuple[str, Any]]


def _head(place: str) -> tuple[_Parameters, str]:
    """Parameters and docstring of a function of a module, which is read as text."""
    module, _, name = place.partition(":")
    signature, text = head_of(Path(__file__).parents[1].joinpath(*module.split(".")[1:]).with_suffix(".py"), name)
    function = ast.parse(f"def {name}({signature.rpartition(':')[0]}: ...").body[0]
    assert isinstance(function, ast.FunctionDef)  # noqa: S101 - it is written so
    of = function.args
    defaults = [None] * (len(of.args) - len(of.defaults)) + [*of.defaults, *of.kw_defaults]
    return {
        each.arg: (_plain(each.annotation), default.value if isinstance(default, ast.Constant) else None)
        for each, default in zip([*of.args, *of.kwonlyargs], defaults, strict=True)
    }, inspect.cleandoc(text)


def _of_object(source: Callable[..., Any]) -> tuple[_Parameters, str]:
    return {
        name: (_plain(each.annotation), None if each.default is each.empty else each.default)
        for name, each in inspect.signature(source).parameters.items()
    }, inspect.getdoc(source) or ""


def _plain(annotation: Any) -> str:
    text = ast.unparse(annotation) if isinstance(annotation, ast.AST) else str(annotation)
    return text.removesuffix(" | None")


def _sentences(text: str) -> dict[str, str]:
    """What a docstring says of each parameter."""
    section = text.partition(_PARAMETERS)[2].partition("\n\n")[0]
    return {name: " ".join(text.split()) for names, text in _PARAMETER.findall(section) for name in names.split(", ")}


def takes(
    plot: str = "", *, json: bool = True, watched: bool = True, **groups: Options
) -> Callable[[Command], Command]:
    """Make a function a command: it gets groups of options as tables, by names of its parameters.

    Its answer is given as --plot and --json say, where `plot` is the sentence of that option; all other sentences of
    the help are those of its docstring. While it works, stderr says so, unless it is `watched` otherwise.
    """

    def decorated(command: Command) -> Command:
        declared, text = inspect.signature(command).parameters, inspect.getdoc(command) or ""
        sentences, hints = _sentences(text), inspect.get_annotations(command, eval_str=True)
        parameters: list[inspect.Parameter] = []
        for name, each in declared.items():
            if name in groups:
                parameters += [option.parameter for option in groups[name].values()]
            elif name != "plot":
                how = Parameter(help=sentences.get(name))
                parameters.append(each.replace(annotation=Annotated[hints[name], how]))
        parameters += [Option("--plot", Path, plot).parameter] if plot else []
        parameters += [Option("--json", bool, _JSON, default=False).parameter] if json else []

        @wraps(command)
        def called(*arguments: Any, **values: Any) -> None:
            typed = {each.name: each.default for each in parameters if each.kind is each.KEYWORD_ONLY} | values
            tables = {name: group.values_of(typed) for name, group in groups.items()}
            known = {each.name for each in parameters}
            mine = {name: value for name, value in typed.items() if name in declared or name not in known}
            title = f"optlaws {command.__name__}"
            with busy(title) if watched else nullcontext():
                answer = command(*arguments, **{**mine, **tables})
            if answer is not None:
                answer.give(typed.get("plot"), as_json=typed.get("json", False), name=title)

        called.__signature__ = inspect.Signature(parameters)  # type: ignore[attr-defined]
        called.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
        called.__doc__ = re.sub(r"(?<=\S)\n(?=\S)", " ", text.partition("\n\nParameters")[0])
        return called

    return decorated


def given(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values that are given: those of options that have been typed, and defaults.

    >>> given({"stroke": "35 mm", "duration": None})
    {'stroke': '35 mm'}
    """
    return {name: value for name, value in values.items() if value is not None}
