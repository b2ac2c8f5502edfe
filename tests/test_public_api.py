"""Rules that every public name of optlaws keeps."""

import inspect
import re
import subprocess
import sys
from collections.abc import Callable
from enum import EnumType
from functools import cached_property
from typing import Any, Literal, get_args, get_origin

import pytest

import optlaws
import optlaws.laws
import optlaws.typing
from docs._ext.made_parts import with_parts
from optlaws import InputError
from tests.documents import ROOT
from tests.internals.entries import Declared
from tests.internals.mechanisms import MechanismKind


def is_method(one: object) -> bool:
    return not isinstance(one, cached_property) and inspect.isroutine(one)


NAMES: list[str] = vars(optlaws)["__all__"]
CALLABLES = {name: one for name in NAMES if callable(one := getattr(optlaws, name)) and not isinstance(one, EnumType)}
# a table of the constants has no text of its own; the objects in it have their class's
DOCUMENTED = [name for name in NAMES if name != "FUNCTIONALS"]
METHODS = {
    f"{name}.{method}": function
    for name in NAMES
    if inspect.isclass(owner := getattr(optlaws, name))
    for method, function in inspect.getmembers(owner, is_method)
    if not method.startswith("_") and str(getattr(function, "__module__", "")).startswith("optlaws")
}


def parameters(function: Callable[..., Any]) -> list[inspect.Parameter]:
    try:
        signature = inspect.signature(function)
    except ValueError:
        return []  # exceptions made of a message alone
    return [
        parameter
        for parameter in signature.parameters.values()
        if parameter.kind not in {parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD}
    ]


def styled(function: Callable[..., Any]) -> bool:
    """Whether it hands a style of lines on to matplotlib."""
    name = getattr(function, "__name__", "")
    return name == "plot" and any(p.name == "style" for p in inspect.signature(function).parameters.values())


def own_documentation(one: object) -> str:
    return inspect.cleandoc(one.__doc__ or "")


def by_kind(name: str) -> tuple[int, str]:
    """Tables, then classes and constants of a law, then functions; alphabetically within each."""
    return (0 if len(name) > 1 and name.isupper() else 1 if name[0].isupper() else 2, name)


def test_the_public_names_are_sorted_and_exist() -> None:
    assert sorted(NAMES, key=by_kind) == NAMES
    assert len(set(NAMES)) == len(NAMES)
    assert all(hasattr(optlaws, name) for name in NAMES)


def test_every_public_name_has_a_summary_and_an_example() -> None:
    names = {*DOCUMENTED, *vars(optlaws.laws)["__all__"]}
    texts = {name: own_documentation(getattr(optlaws, name, None) or getattr(optlaws.laws, name)) for name in names}
    assert [name for name, text in texts.items() if not text.partition("\n")[0].strip() or ">>> " not in text] == []


def undocumented(one: Callable[..., Any]) -> list[str]:
    text = own_documentation(one)
    if inspect.isclass(one):  # what a base class says of its parameters holds for those it leaves to it
        inherited = [base for base in inspect.getmro(one)[1:] if str(base.__module__).startswith("optlaws")]
        text = "\n".join([text, *map(own_documentation, inherited)])
    return [
        parameter.name
        for parameter in parameters(one)
        if not parameter.name.startswith("_") and not re.search(rf"(?<!\w){re.escape(parameter.name)}(?!\w)", text)
    ]


def test_every_parameter_is_documented() -> None:
    assert {name: missing for name, one in CALLABLES.items() if (missing := undocumented(one))} == {}


def refusal(function: Callable[..., Any]) -> str:
    """What is said of a keyword that there is not."""
    try:
        function(misspelt_keyword=1)
    except (TypeError, InputError) as error:
        return str(error)
    return "taken"


def test_a_misspelt_keyword_is_refused() -> None:
    # abstract classes cannot be made, and matplotlib refuses what it does not know of a style
    asked = {
        name: function
        for name, function in (CALLABLES | METHODS).items()
        if not (inspect.isclass(function) and inspect.isabstract(function)) and not styled(function)
    }
    reasons = {name: refusal(function) for name, function in asked.items()}
    refused = re.compile("unexpected keyword|takes no (keyword )?arguments|no arguments|unknown entry of .* known are")
    assert {name: text for name, text in reasons.items() if not refused.search(text)} == {}


def makes_values(name: str, function: object) -> bool:
    """Whether it takes the entries of a value: its class, or the function of a kind of mechanism."""
    kinds = {kind.replace(" ", "_") for kind in MechanismKind.kinds()}
    return name in kinds or (inspect.isclass(function) and issubclass(function, Declared) and function is not Declared)


MAKERS = {name: one for name, one in CALLABLES.items() if makes_values(name, one) and not inspect.isabstract(one)}


@pytest.mark.parametrize("name", MAKERS)
def test_whatever_takes_entries_names_the_one_that_it_does_not_know_or_lacks(name: str) -> None:
    with pytest.raises(InputError, match=r"unknown entry of .* 'misspelt_keyword'; known are ") as wrong:
        MAKERS[name](misspelt_keyword=1)
    assert isinstance(wrong.value, TypeError)
    parameters = inspect.signature(MAKERS[name]).parameters
    for needed in (each.name for each in parameters.values() if each.default is each.empty):
        with pytest.raises(InputError, match=r" needs its \w+"):
            MAKERS[name](**dict.fromkeys(parameters.keys() - {needed}))


def test_the_name_of_a_link_is_one_of_its_bodies() -> None:
    with pytest.raises(InputError, match="unknown entry of a slider crank 'slide'; did you mean 'bodies'"):
        optlaws.slider_crank("30 mm", "100 mm", slide="2 kg")  # type: ignore[call-arg]


def test_an_entry_in_the_wrong_table_is_refused_with_the_table_that_has_it() -> None:
    moves = [optlaws.Rise("3 mm", "0.1 s"), optlaws.Return()]
    with pytest.raises(InputError, match=r"unknown entry of a cycle 'acceleration'; it is an entry of 'limits'$"):
        optlaws.Cycle(moves, period="0.3 s", acceleration="1 m/s^2")  # type: ignore[call-arg]
    stored = optlaws.Cycle(moves, period="0.3 s").to_dict()
    with pytest.raises(InputError, match=r"unknown entry of a stored cycle 'jerk'; it is an entry of 'limits'$"):
        optlaws.Cycle.from_dict(stored | {"jerk": "90 m/s^3"})


@pytest.mark.parametrize("value", [optlaws.smoothstep(3), optlaws.synthesize(optlaws.Problem(B=1.7, order=3))])
def test_a_misspelt_style_is_refused_by_what_draws(value: optlaws.MotionLaw | optlaws.Solution) -> None:
    with pytest.raises(AttributeError, match="misspelt_keyword"):
        value.plot(misspelt_keyword=1)


def swallows(function: Callable[..., Any]) -> bool:
    if inspect.isclass(function) and issubclass(function, Exception) and "__init__" not in vars(function):
        return False
    return any(parameter.kind is parameter.VAR_KEYWORD for parameter in inspect.signature(function).parameters.values())


def test_no_public_callable_swallows_keywords() -> None:
    every = CALLABLES | METHODS
    assert [name for name, function in every.items() if swallows(function) and not styled(function)] == []


def annotated(function: Callable[..., Any]) -> bool:
    signature = inspect.signature(function)
    own = [parameter for parameter in signature.parameters.values() if parameter.name not in {"self", "cls"}]
    return signature.return_annotation is not signature.empty and all(one.annotation is not one.empty for one in own)


def test_every_public_callable_is_annotated() -> None:
    functions = {name: one for name, one in (CALLABLES | METHODS).items() if not inspect.isclass(one)}
    assert [name for name, function in functions.items() if not annotated(function)] == []


#: what the standard library, numpy, pandas and xarray have
OTHERS = {"Any", "Callable", "Executor", "Fraction", "Iterable", "Iterator", "Literal", "Mapping", "NDArray", "None"}
OTHERS |= {
    "Path",
    "Self",
    "Sequence",
    "bool",
    "class",
    "dict",
    "float",
    "int",
    "list",
    "object",
    "str",
    "tuple",
    "type",
}
OTHERS |= {"np.bool_", "np.complex128", "np.float64", "np.intp", "np.object_", "pd.DataFrame", "xr.Dataset"}


def test_annotations_name_public_types() -> None:
    """Those of optlaws itself, or of `optlaws.typing`, which has the very types that the annotations mean."""
    unknown = {}
    for name, function in (CALLABLES | METHODS).items():
        room = vars(inspect.getmodule(inspect.unwrap(function)))
        for word in words_of(function) - OTHERS - set(NAMES):
            known = getattr(optlaws.typing, word, None)
            if known is None or room.get(word, known) != known:
                unknown[f"{name}: {word}"] = known
    assert unknown == {}


def words_of(function: Callable[..., Any]) -> set[str]:
    """The names in the annotations of a callable, but for the words of literals."""
    try:
        parts = inspect.signature(function)
    except ValueError:
        return set()  # exceptions made of a message alone
    texts = [parts.return_annotation, *(one.annotation for one in parts.parameters.values())]
    plain = (re.sub(r"'[^']*'|\"[^\"]*\"|<[^>]*>", "", str(text)) for text in texts if text is not parts.empty)
    return {word for text in plain for word in re.findall(r"[A-Za-z_][\w.]*", text)}


def test_everything_raised_on_purpose_is_one_tree() -> None:
    found = [one for name in NAMES if inspect.isclass(one := getattr(optlaws, name)) and issubclass(one, Exception)]
    warnings = {one for one in found if issubclass(one, Warning)}
    assert {warning.__name__ for warning in warnings} == {"NoisyTable", "NotNormalised"}
    errors = [one for one in found if one not in warnings]
    known = {"CallError", "InfeasibleProblem", "InputError", "OptlawsError", "SolverFailure"}
    assert {error.__name__ for error in errors} == known
    assert all(issubclass(error, optlaws.OptlawsError) and ">>>" in (error.__doc__ or "") for error in errors)


def test_an_unknown_attribute_is_refused() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'sythesize'"):
        _ = optlaws.sythesize  # type: ignore[attr-defined]


def test_star_import_gives_the_public_names_and_no_more() -> None:
    script = "before = {*dir()}\nfrom optlaws import *\nprint(*sorted({*dir()} - before - {'before'}))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == sorted(NAMES)


def test_the_table_of_constants_names_each_public_one() -> None:
    for name, one in optlaws.FUNCTIONALS.items():
        assert getattr(optlaws, name) is one
        assert repr(one) == one.name == name


def test_the_page_of_types_names_each_of_them_and_the_words_of_each_choice() -> None:
    page = with_parts("reference/api/results", (ROOT / "docs/reference/api/results.md").read_text("utf-8"))
    rows = re.findall(r"^\| (`.*?) \| (.*?) \|", page, re.MULTILINE)
    words = {name: re.findall("`(.*?)`", row) for names, row in rows for name in re.findall("`(.*?)`", names)}
    assert sorted(words) == sorted(vars(optlaws.typing)["__all__"])
    for name, listed in words.items():
        kind = getattr(optlaws.typing, name)
        if get_origin(kind) is Literal:
            assert listed == list(get_args(kind))


@pytest.mark.parametrize(
    ("make", "instead"),
    [
        (lambda: optlaws.Problem(order=3, degree=13), r"'degree': give basis=Chebyshev\(13\)"),  # type: ignore[call-arg] # it is refused
        (lambda: optlaws.Cycle([optlaws.Rise("1 m", "1 s")], rpm=200), "'rpm': give speed=\"200 rpm\""),  # type: ignore[call-arg] # it is refused
    ],
)
def test_what_stands_elsewhere_is_refused_with_its_place(make: Callable[[], Any], instead: str) -> None:
    with pytest.raises(InputError, match=instead) as refused:
        make()
    assert isinstance(refused.value, TypeError)
