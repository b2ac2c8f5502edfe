"""Formulas from callables, which are traced with CasADi's symbols and read as a tree."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.formulas.functions import SMOOTH_FUNCTIONS
from optlaws.formulas.reading import LONGEST
from optlaws.formulas.slopes import added, multiplied, opposite
from optlaws.formulas.tree import VOCABULARY, Call, Exponentiation, Formula, Name, Number, Reciprocal, number
from optlaws.locks import casadi_lock

_MOST = 2000


def text_of(function: Callable[..., Any]) -> str:
    """The formula that a callable of some of k, a, b, c, d, j writes down, as text.

    Examples
    --------
    >>> text_of(lambda k, b, c: c + (1 + k) * b)
    'c + (1 + k)*b'
    """
    names = list(inspect.signature(function).parameters)
    if not names or not set(names) <= set(VOCABULARY):
        raise InputError(f"a formula is a function of some of {', '.join(VOCABULARY)}, got {shortened(names)}")
    with casadi_lock:
        return _read(function, names)


def _read(function: Callable[..., Any], names: list[str]) -> str:
    import casadi as ca

    symbols = [ca.SX.sym(name) for name in names]
    try:
        graph = ca.Function("formula", symbols, [ca.SX(function(*symbols))])
    except (TypeError, ValueError, NotImplementedError, RuntimeError) as error:
        raise InputError(f"the function writes down no formula of CasADi's symbols: {error}") from None
    if graph.numel_out() != 1 or graph.n_instructions() > _MOST:
        raise InputError(f"a formula is one expression of at most {_MOST} operations")
    operations = {
        getattr(ca, f"OP_{operation}"): operation
        for operation in (*map(str.upper, SMOOTH_FUNCTIONS), *_OPERATIONS, "CONST", "INPUT", "OUTPUT")
    }
    work: dict[int, Formula] = {}
    for i in range(graph.n_instructions()):
        kind = operations.get(graph.instruction_id(i))
        taken = graph.instruction_input(i)
        if kind == "OUTPUT":
            return str(work[taken[0]])
        if kind is None:
            raise InputError("the function uses an operation that formulas do not have")
        if kind == "INPUT":
            formula: Formula = Name(names[taken[0]])
        elif kind == "CONST":
            formula = number(float(graph.instruction_constant(i)))
        elif kind in _OPERATIONS:
            formula = _OPERATIONS[kind](*(work[place] for place in taken))
        else:
            formula = Call(kind.lower(), (work[taken[0]],))
        if len(str(formula)) > LONGEST:
            raise InputError(f"a formula may have {LONGEST} characters, and that of the function has more")
        work[graph.instruction_output(i)[0]] = formula
    raise InputError("the function writes down nothing")


_OPERATIONS: dict[str, Callable[..., Formula]] = {
    "ADD": lambda x, y: added([x, y]),
    "SUB": lambda x, y: added([x, opposite(y)]),
    "MUL": lambda x, y: multiplied([x, y]),
    "DIV": lambda x, y: multiplied([x, Reciprocal(y)]),
    "NEG": opposite,
    "SQ": lambda x: Exponentiation(x, Number(2.0)),
    "TWICE": lambda x: multiplied([Number(2.0), x]),
    "INV": Reciprocal,
    "POW": Exponentiation,
    "CONSTPOW": Exponentiation,
    "ASSIGN": lambda x: x,
    "FABS": lambda x: Call("abs", (x,)),
    "FMAX": lambda x, y: Call("max", (x, y)),
    "FMIN": lambda x, y: Call("min", (x, y)),
    "HYPOT": lambda x, y: Call("norm", (x, y)),
}
