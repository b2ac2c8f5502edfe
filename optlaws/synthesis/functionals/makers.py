"""Constructors of constants from formulas: `peak("c + 0.2*b")`, `rms(...)`, and the torque of a drive."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import replace
from math import nan
from typing import TYPE_CHECKING, Any, Literal

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.formulas.of_motion import MotionFormula, checked, of_text
from optlaws.formulas.reading import LONGEST, FormulaError, read
from optlaws.formulas.slopes import added, derivative, multiplied, opposite
from optlaws.formulas.tree import (
    ORDERS,
    SMOOTH_FUNCTIONS,
    VOCABULARY,
    Call,
    Exponentiation,
    Formula,
    Name,
    Number,
    Reciprocal,
    number,
    plain,
)
from optlaws.lazy import casadi_lock
from optlaws.numbers import real
from optlaws.synthesis.problem.constants import MAKERS, Functional

if TYPE_CHECKING:
    from optlaws.synthesis.functionals.kinds import OfFormula

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


#: of a peak: the greatest magnitude, the greatest value, or the greatest opposite
PeakSide = Literal["both", "high", "low"]
FormulaKind = Literal["peak", "rms", "integral", "value"]
_SIDES = {"both": (1.0, -1.0), "high": (1.0,), "low": (-1.0,)}


def peak(formula: Any, *, side: PeakSide = "both", start: float = 0.0, stop: float = 1.0) -> Functional:
    """The peak of a formula of the motion, over the whole of the interval or a part of it.

    Parameters
    ----------
    formula
        Text in a, b, c, j (derivatives of the law), d = b c and k, such as "c + 0.2*b" or "(1 + k)*c", or a function
        of some of these that writes it down with CasADi's symbols.
    side
        "both" for the greatest magnitude, "high" for the greatest value, "low" for the greatest opposite.
    start, stop
        The part of the interval.

    Raises
    ------
    InputError
        If the formula cannot be read or has no peak; the error points at the place in the text.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> peak("c + 3*b"), round(peak("c + 3*b").value(smoothstep(3)), 6)
    (peak(c + 3*b), 9.009603)
    """
    from optlaws.synthesis.functionals.kinds import FormulaPeak

    check_names([side], _SIDES, "side")
    motion = _motion(formula, *_part(start, stop))
    name = _name("peak", motion, *([] if side == "both" else [f"side={side}"]))
    peak = FormulaPeak(name, nan, convex=True, motion=motion, signs=_SIDES[side])
    convex = motion.affine is not None or all(branch.convex for branch in peak.branches(symmetric=False))
    return _checked(replace(peak, convex=convex), formula)


def rms(formula: Any, *, start: float = 0.0, stop: float = 1.0) -> Functional:
    """The root mean square of a formula of the motion, over the whole of the interval or a part of it.

    Parameters
    ----------
    formula, start, stop
        As `peak` takes them, with the same errors.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> round(rms("c").value(smoothstep(2)) ** 2, 9)
    12.0
    """
    from optlaws.synthesis.functionals.kinds import FormulaRms

    motion = _motion(formula, *_part(start, stop, "rms"))
    name = _name("rms", motion)
    rms = FormulaRms(name, nan, convex=True, motion=motion)
    kind = motion.curvature
    convex = motion.affine is not None or (kind.convex and rms.sign > 0) or (kind.concave and rms.sign < 0)
    return _checked(replace(rms, convex=convex), formula)


def integral(formula: Any, *, start: float = 0.0, stop: float = 1.0) -> Functional:
    """The integral of a formula of the motion, over the whole of the interval or a part of it.

    Parameters
    ----------
    formula, start, stop
        As `peak` takes them, with the same errors.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> energy = integral("c^2 + (1 + k)*b^2")
    >>> round(energy.value(smoothstep(2)), 9), energy.convexity
    (13.8, 'convex: every term of c^2 + (1 + k)*b^2 is convex')
    """
    from optlaws.synthesis.functionals.kinds import FormulaIntegral

    motion = _motion(formula, *_part(start, stop, "integral"))
    integral = FormulaIntegral(_name("integral", motion), nan, convex=motion.curvature.convex, motion=motion)
    return _checked(integral, formula)


def value(formula: Any, *, at: float) -> Functional:
    """The value of a formula of the motion at one k.

    Parameters
    ----------
    formula
        As `peak` takes it, with the same errors.
    at
        The k.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> value("c", at=0.25), value("c", at=0.25).value(smoothstep(2))
    (value(c, at=0.25), 3.0)
    """
    from optlaws.synthesis.functionals.kinds import FormulaValue

    place = _place(at, "at")
    motion = _motion(formula, place, place)
    name = f"value({motion.formula}, at={plain(place)})"
    return _checked(FormulaValue(name, nan, convex=motion.curvature.convex, motion=motion), formula)


def functional(
    function: Callable[..., Any],
    kind: FormulaKind = "peak",
    *,
    side: PeakSide = "both",
    start: float = 0.0,
    stop: float = 1.0,
    at: float | None = None,
) -> Functional:
    """A constant of the formula that a function of k, a, b, c, d, j writes down with CasADi's symbols.

    Parameters
    ----------
    function
        Called once with symbols; its parameters' names say which of these it takes.
    kind
        "peak", "rms", "integral" or "value".
    side
        Of a peak: "both", "high" or "low".
    start, stop
        The part of the interval.
    at
        The k of a value.

    Raises
    ------
    InputError
        If the kind is unknown, or the function writes down no formula.

    Examples
    --------
    >>> functional(lambda k, b, c: c + (1 + k) * b, kind="rms")
    rms(c + (1 + k)*b)
    """
    check_names([kind], _KINDS, "kind")
    if (kind == "value") != (at is not None):
        raise InputError(f"a value needs at, its k, and no other constant takes it; got {at!r}")
    if at is not None:
        return value(function, at=at)
    if kind == "peak":
        return peak(function, side=side, start=start, stop=stop)
    return _KINDS[kind](function, start=start, stop=stop)


def drive_torque(*, inertia: str = "1", friction: str = "0", load: str = "0") -> str:
    """The torque I(a) c + I'(a) b²/2 + friction b + load that drives a law, as the text of a formula.

    Parameters
    ----------
    inertia
        Moment of inertia over the displacement a, in the units of the other arguments: "1", "1 + 0.3*a^2",
        "spline(a, 0:1, 0.3:1.1, 0.7:1.4, 1:1.3)".
    friction
        Viscous friction, of a and k.
    load
        External force over k or over a: "4*a", "table(k, 0:0, 0.4:0, 0.5:6, 0.6:0, 1:0)".

    Raises
    ------
    InputError
        If a part is no formula of a and k, or the inertia has kinks.

    Examples
    --------
    >>> drive_torque(friction="0.5", load="4*a")
    'c + 0.5*b + 4*a'
    >>> drive_torque(inertia="1 + 0.3*a^2")
    '(1 + 0.3*a^2)*c + 0.5*0.3*2*a*b^2'
    >>> drive_torque(inertia="spline(a, 0:1, 0.3:1.1, 0.7:1.4, 1:1.3)")[-44:]
    'spline1(a, 0:1, 0.3:1.1, 0.7:1.4, 1:1.3)*b^2'
    """
    mass, drag, force = (read(text, ("a", "k")) for text in (inertia, friction, load))
    square = Exponentiation(Name("b"), Number(2.0))
    turning = multiplied([Number(0.5), derivative(mass, "a"), square])
    return str(added([multiplied([mass, Name("c")]), turning, multiplied([drag, Name("b")]), force]))


def _motion(formula: Any, start: float, stop: float) -> MotionFormula:
    """The formula of a text or a tree, which must depend on the law."""
    if isinstance(formula, Formula):
        motion, text = checked(MotionFormula(formula, start, stop), str(formula)), str(formula)
    elif isinstance(formula, str) or callable(formula):
        text = formula if isinstance(formula, str) else text_of(formula)
        motion = of_text(text, start, stop)
    else:
        raise InputError(f"a formula is a text such as 'c + 0.2*b' or a function, got {shortened(formula)}")
    if not motion.formula.names() & ORDERS.keys():
        raise FormulaError("the formula has none of a, b, c, d, j: no law changes it", text, 0)
    return motion


def _checked(constant: OfFormula, formula: Any) -> OfFormula:
    """The constant, if it can be minimised and bounded."""
    from optlaws.synthesis.functionals.kinds import refusal

    why = refusal(constant)
    if why is not None:
        text = formula if isinstance(formula, str) else str(constant.motion.formula)
        kinked = next(part for part in constant.motion.formula.different if part.kinked)
        raise FormulaError(why, text, kinked.place)
    return constant


def _part(start: object, stop: object, integrated: str = "") -> tuple[float, float]:
    """The ends of a part of the interval; what is integrated needs more than a place."""
    first, last = _place(start, "start"), _place(stop, "stop")
    if first > last:
        raise InputError(f"a part of the interval needs start <= stop, got {start!r} and {stop!r}")
    if integrated and first == last:
        raise InputError(f"{integrated} needs a part of the interval with start < stop, got {start!r} and {stop!r}")
    return first, last


def _place(k: object, name: str) -> float:
    number = real(k)
    if number is None or not 0.0 <= number <= 1.0:
        raise InputError(f"{name} must be a k from 0 to 1, got {shortened(k)}")
    return float(number)


def _name(kind: str, motion: MotionFormula, *others: str) -> str:
    parts = [str(motion.formula), *others]
    parts += [f"start={plain(motion.start)}"] if motion.start != 0.0 else []
    parts += [f"stop={plain(motion.stop)}"] if motion.stop != 1.0 else []
    return f"{kind}({', '.join(parts)})"


_KINDS: dict[str, Callable[..., Functional]] = {
    "integral": integral,
    "peak": peak,
    "rms": rms,
    "value": value,
}

for _kind, _maker in _KINDS.items():
    MAKERS.setdefault(_kind, _maker)
