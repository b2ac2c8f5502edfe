"""Constants by their names: plain ones such as rms_c, and ones with arguments such as C_cam(nu=20, damping=0.05)."""

from __future__ import annotations

from functools import lru_cache

from optlaws.errors import InputError
from optlaws.synthesis.problem.constants import FUNCTIONALS, MAKERS, PLAIN, WITHOUT_ARGUMENTS, Functional
from optlaws.synthesis.problem.expression import Expression, Term
from optlaws.synthesis.problem.grammar import parse


@lru_cache(maxsize=256)
def expression(text: str) -> Expression:
    """The objective that a text says.

    Examples
    --------
    >>> expression("0.5*C/4 + C_cam(nu=20)")
    0.125*C + C_cam(nu=20.0)
    """
    return parse(text, WITHOUT_ARGUMENTS, MAKERS)


def named(text: str) -> Functional:
    """The constant that a text names.

    Examples
    --------
    >>> named("rms_c"), named("residual(nu=(18, 22))")
    (rms_c, residual(nu=(18.0, 22.0)))
    """
    terms = expression(text).terms
    (weight, constant), *others = terms
    if others or weight != 1.0 or not isinstance(constant, Functional):
        raise InputError(f"{text!r} is no constant of a law but an expression")
    return constant


def title_of(name: str) -> str:
    """What messages and tables call the constant of a name.

    Examples
    --------
    >>> title_of("rms_c"), title_of("peak(c + 3*b)")
    ('rms_c', 'peak(c + 3*b)')
    """
    if name in WITHOUT_ARGUMENTS:
        return name
    try:
        return named(name).title
    except InputError:
        return name


def is_named(term: Term) -> bool:
    """Whether its name alone tells what it is, so that text can stand for it.

    Examples
    --------
    >>> from optlaws.synthesis import C
    >>> is_named(C)
    True
    """
    text = repr(term)
    if FUNCTIONALS.get(text) == term or PLAIN.get(text) == term:
        return True
    if text.partition("(")[0] not in MAKERS:
        return False
    try:
        return named(text) == term
    except InputError:
        return False


def apart(text: str) -> list[str]:
    """What stands between the commas that are in no bracket.

    Examples
    --------
    >>> apart("residual(nu=(18, 22)), C")
    ['residual(nu=(18, 22))', 'C']
    """
    parts, depth = [""], 0
    for character in text:
        depth += (character == "(") - (character == ")")
        if character == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += character
    return [part.strip() for part in parts]
