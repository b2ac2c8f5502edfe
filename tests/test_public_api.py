"""Rules that every public name of optlaws keeps."""

import inspect
import re
import subprocess
import sys
from collections.abc import Callable
from enum import EnumType
from functools import cached_property
from typing import Any

import pytest

import optlaws


def is_method(one: object) -> bool:
    return not isinstance(one, cached_property) and inspect.isroutine(one)


NAMES = optlaws.__all__
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
    return [one for one in signature.parameters.values() if one.kind not in {one.VAR_POSITIONAL, one.VAR_KEYWORD}]


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


@pytest.mark.parametrize("name", DOCUMENTED)
def test_every_public_name_has_a_summary_and_an_example(name: str) -> None:
    text = own_documentation(getattr(optlaws, name))
    assert text.partition("\n")[0].strip()
    assert ">>> " in text


@pytest.mark.parametrize("name", CALLABLES)
def test_every_parameter_is_documented(name: str) -> None:
    one = CALLABLES[name]
    text = own_documentation(one)
    if inspect.isclass(one):  # what a base class says of its parameters holds for those it leaves to it
        inherited = [base for base in inspect.getmro(one)[1:] if str(base.__module__).startswith("optlaws")]
        text = "\n".join([text, *map(own_documentation, inherited)])
    missing = [
        parameter.name
        for parameter in parameters(one)
        if not parameter.name.startswith("_") and not re.search(rf"(?<!\w){re.escape(parameter.name)}(?!\w)", text)
    ]
    assert missing == []


@pytest.mark.parametrize("name", METHODS)
def test_every_public_method_says_what_it_is(name: str) -> None:
    assert inspect.getdoc(METHODS[name])


@pytest.mark.parametrize("name", [*CALLABLES, *METHODS])
def test_a_misspelt_keyword_is_refused(name: str) -> None:
    function = CALLABLES.get(name) or METHODS[name]
    if inspect.isclass(function) and inspect.isabstract(function):
        pytest.skip("cannot be made")
    if styled(function):
        pytest.skip("matplotlib refuses what it does not know")
    with pytest.raises(TypeError, match=r"unexpected keyword|takes no (keyword )?arguments|no arguments"):
        function(misspelt_keyword=1)


@pytest.mark.parametrize("value", [optlaws.smoothstep(3), optlaws.synthesize(optlaws.Problem(B=1.7, order=3))])
def test_a_misspelt_style_is_refused_by_what_draws(value: optlaws.MotionLaw | optlaws.Solution) -> None:
    with pytest.raises(AttributeError, match="misspelt_keyword"):
        value.plot(misspelt_keyword=1)


@pytest.mark.parametrize("name", [*CALLABLES, *METHODS])
def test_no_public_callable_swallows_keywords(name: str) -> None:
    function = CALLABLES.get(name) or METHODS[name]
    if inspect.isclass(function) and issubclass(function, Exception) and "__init__" not in vars(function):
        return
    swallowed = [p for p in inspect.signature(function).parameters.values() if p.kind is p.VAR_KEYWORD]
    assert styled(function) or not swallowed


@pytest.mark.parametrize("name", [*CALLABLES, *METHODS])
def test_every_public_callable_is_annotated(name: str) -> None:
    function = CALLABLES.get(name) or METHODS[name]
    if inspect.isclass(function):
        return
    signature = inspect.signature(function)
    assert signature.return_annotation is not signature.empty
    assert all(p.annotation is not p.empty for p in signature.parameters.values() if p.name not in {"self", "cls"})


def test_everything_raised_on_purpose_is_one_tree() -> None:
    found = [one for name in NAMES if inspect.isclass(one := getattr(optlaws, name)) and issubclass(one, Exception)]
    warnings = {one for one in found if issubclass(one, Warning)}
    assert {one.__name__ for one in warnings} == {"NotNormalised"}
    errors = [one for one in found if one not in warnings]
    assert {one.__name__ for one in errors} == {"InfeasibleProblem", "InputError", "OptlawsError", "SolverFailure"}
    assert all(issubclass(one, optlaws.OptlawsError) for one in errors)


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
