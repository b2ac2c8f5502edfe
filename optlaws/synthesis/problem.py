"""The problem to be solved, a frozen value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, lru_cache
from math import isfinite
from numbers import Real
from typing import Any

from optlaws.errors import InputError
from optlaws.laws.checks import whole
from optlaws.suggest import unknown_key
from optlaws.synthesis.bases import Basis, Chebyshev, PolynomialBasis, basis
from optlaws.synthesis.boundary import BoundaryConditions
from optlaws.synthesis.bounds import Range, as_range
from optlaws.synthesis.expression import Expression, Term, leaves
from optlaws.synthesis.functionals import ALIASES, FUNCTIONALS, C_minus, C_plus
from optlaws.synthesis.grammar import parse
from optlaws.synthesis.windows import Window

CONSTANTS = ("B", "C", "D", "J")


@dataclass(frozen=True, kw_only=True, repr=False)
class Problem:
    """Minimise an objective over the laws (8) with given end conditions and constants (eq. 10); dimensionless.

    Parameters
    ----------
    order
        Number l of boundary conditions at each end, at least 1.
    minimise
        A constant or a sum or maximum of constants: "C", "D", "0.6*C/4 + 0.4*D/2.25", `0.6 * C / 4 + 0.4 * D / 2.25`.
    B, C, D, J
        Peak velocity, acceleration, power and jerk: a number fixes the constant, a `Range` such as
        `between(1.5, 1.8)` or `at_most(60)` bounds it, None leaves it free. In a symmetric law B is b(1/2), and
        b <= B holds everywhere.
    basis
        Basis of Z(k) with its degree: `Powers(9)`, `Chebyshev(9)`.
    monotone
        Ask b >= 0 too.
    symmetric
        Ask a(k) + a(1-k) = 1. From rest to rest the optimum is the same either way where the objective is convex and
        treats rise and fall alike and there are no windows (the mean of a law and its mirror image is no worse).
    boundary
        End conditions; rest to rest unless given. Others make the law unsymmetric.
    windows
        Values and windows of a, b, c, j: `via("a", 0.3, at=0.4)`, `Window("b", high=1.2, start=0.2, stop=0.3)`.

    Raises
    ------
    InputError
        If a value is out of range, or the degree leaves Z no freedom.

    Examples
    --------
    >>> Problem(B=1.859, order=4, basis=Chebyshev(9))
    Problem(B=1.859, order=4, basis=Chebyshev(degree=9), minimise='C')
    """

    B: float | Range | None = None
    order: int = 0
    basis: Basis = field(default_factory=lambda: Chebyshev(9))
    minimise: str | Expression = "C"
    monotone: bool = False
    symmetric: bool = True
    C: float | Range | None = None
    D: float | Range | None = None
    J: float | Range | None = None
    boundary: BoundaryConditions | None = None
    windows: tuple[Window, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "order", _order(self.order, self.boundary))
        object.__setattr__(self, "windows", _windows(self.windows))
        _check_choices(self.basis, monotone=self.monotone, symmetric=self.symmetric)
        object.__setattr__(self, "minimise", _canonical(self.minimise))
        for name in CONSTANTS:
            object.__setattr__(self, name, _constant(getattr(self, name), name))
        if self.boundary is not None:
            if self.boundary == BoundaryConditions.rest(self.order):
                object.__setattr__(self, "boundary", None)
            elif self.symmetric:
                raise InputError("a law with these boundary conditions is not symmetric: ask symmetric=False")
        self.basis.check(symmetric=self.symmetric)

    @cached_property
    def objective(self) -> Expression:
        """What is minimised."""
        return _parsed(self.minimise) if isinstance(self.minimise, str) else self.minimise

    @property
    def conditions(self) -> BoundaryConditions:
        """The end conditions."""
        return self.boundary if self.boundary is not None else BoundaryConditions.rest(self.order)

    @cached_property
    def convex(self) -> bool:
        """Whether every constant in the objective and every bounded one is convex in the law."""
        names = {name for name in CONSTANTS if getattr(self, name) is not None}
        return "D" not in names and all(leaf.convex for _, leaf in leaves(self.objective))  # type: ignore[attr-defined]

    @property
    def mirrored(self) -> bool:
        """Whether unsymmetric laws are sought but every bound of symmetric ones holds for them too.

        Where the objective is convex the mean of a law and its mirror image is no worse; where D is in it, that is
        so for the relaxed program.
        """
        one_sided = any(leaf in {C_plus, C_minus} for _, leaf in leaves(self.objective))
        plain = self.boundary is None and not self.windows and isinstance(self.basis, PolynomialBasis)
        return not self.symmetric and plain and not one_sided

    def range(self, name: str) -> Range | None:
        """What is asked of the constant B, C, D or J."""
        return self._ranges[name]

    @cached_property
    def _ranges(self) -> dict[str, Range | None]:
        return {name: as_range(getattr(self, name), name) for name in CONSTANTS}

    @cached_property
    def shape(self) -> Problem:
        """The problem with a fixed B replaced by 2: problems of one shape share their program."""
        return replace(self, B=2.0) if isinstance(self.B, float) and self.B != 2.0 else self

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict.

        Examples
        --------
        >>> Problem.from_dict(Problem(B=2, order=3).to_dict()) == Problem(B=2, order=3)
        True
        """
        found: dict[str, Any] = {"minimise": str(self.minimise), "order": self.order}
        found |= self.basis.to_dict()
        found |= {"monotone": self.monotone, "symmetric": self.symmetric}
        for name in CONSTANTS:
            value = getattr(self, name)
            if value is not None:
                found[name] = value if isinstance(value, float) else _plain(value)
        if self.boundary is not None:
            found["start"] = [float(v) for v in self.boundary.start]
            found["end"] = [float(v) for v in self.boundary.end]
        if self.windows:
            found["windows"] = [window.to_dict() for window in self.windows]
        return found

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Problem:
        """Read a problem from what `to_dict` wrote, or a part of it: the order is needed.

        Raises
        ------
        InputError
            If a key is unknown (the nearest right one is named) or missing, or a value is out of range.
        """
        known: tuple[str, ...] = (
            "minimise",
            *CONSTANTS,
            "order",
            "basis",
            "degree",
            "monotone",
            "symmetric",
            "start",
            "end",
            "windows",
        )
        known = (*known, "breaks", "continuity")
        for key in data:
            if key not in known:
                raise InputError(unknown_key(key, known))
        if "order" not in data and "start" not in data:
            raise InputError("the problem lacks order")
        given = dict(data)
        shape = {name: given.pop(name) for name in ("breaks", "continuity") if name in given}
        chosen = basis(given.pop("basis", "chebyshev"), given.pop("degree", 9), **shape)
        if "start" in given or "end" in given:
            start, end = (_listed(given.pop(name, ()), name) for name in ("start", "end"))
            given["boundary"] = BoundaryConditions(start, end)
        given["windows"] = tuple(Window.from_dict(window) for window in _listed(given.pop("windows", ()), "windows"))
        return cls(basis=chosen, **given)

    def __repr__(self) -> str:
        shown = ("B", "order", "basis", "minimise")
        parts = [f"{f.name}={getattr(self, f.name)!r}" for f in fields(self) if f.name in shown or _given(self, f)]
        return f"Problem({', '.join(parts)})"


def _given(problem: Problem, one: Any) -> bool:  # noqa: ANN401 - a dataclass field
    return bool(getattr(problem, one.name) != one.default)


@lru_cache(maxsize=256)
def _parsed(text: str) -> Expression:
    return parse(text, FUNCTIONALS | ALIASES)


def _canonical(minimise: Any) -> str | Expression:  # noqa: ANN401 - it is checked here
    if isinstance(minimise, str):
        found = _parsed(minimise)
    elif isinstance(minimise, Term | Expression):
        found = minimise.expression()
    else:
        raise InputError(f"minimise must be a constant such as 'C', a sum or an expression, got {minimise!r}")
    known = all(FUNCTIONALS.get(repr(leaf)) == leaf for _, leaf in leaves(found))
    return repr(found) if known else found


def _constant(value: Any, name: str) -> float | Range | None:  # noqa: ANN401 - it is checked here
    if name == "B" and value is not None and not isinstance(value, Range | tuple | list) and not _velocity(value):
        raise InputError(f"B must be a finite number above 1 (the mean velocity is 1), got {value!r}")
    found = as_range(value, name)
    if found is None:
        return None
    if name == "B" and found.high <= 1.0:
        raise InputError(f"B must be able to exceed 1 (the mean velocity is 1), got {value!r}")
    if found.high <= 0.0:
        raise InputError(f"{name} must be able to exceed 0, got {value!r}")
    return found.high if found.fixed else found


def _listed(values: Any, name: str) -> tuple[Any, ...]:  # noqa: ANN401 - it is checked here
    if not isinstance(values, list | tuple):
        raise InputError(f"{name} must be a list, got {values!r}")
    return tuple(values)


def _windows(windows: Any) -> tuple[Window, ...]:  # noqa: ANN401 - they are checked here
    found = tuple(windows) if isinstance(windows, list | tuple) else (windows,)
    for window in found:
        if not isinstance(window, Window):
            raise InputError(f"windows must be Window values such as via('a', 0.3, at=0.4), got {window!r}")
    return found


def _velocity(value: Any) -> bool:  # noqa: ANN401 - it is checked here
    return value is not True and isinstance(value, Real) and isfinite(value) and float(value) > 1.0


def _order(order: Any, boundary: Any) -> int:  # noqa: ANN401 - they are checked here
    if boundary is not None and not isinstance(boundary, BoundaryConditions):
        raise InputError(f"boundary must be BoundaryConditions(start, end), got {boundary!r}")
    if boundary is not None and order in {0, boundary.order}:
        return boundary.order
    found = whole(order, "order", least=1)
    if boundary is not None:
        raise InputError(f"order {found} does not fit {boundary.order} boundary conditions at each end")
    return found


def _plain(one: Range) -> list[float | None]:
    return [one.low, one.high if isfinite(one.high) else None]


def _check_choices(chosen: Any, **switches: Any) -> None:  # noqa: ANN401 - they are checked here
    if not isinstance(chosen, Basis):
        raise InputError(f"basis must be a Basis such as Powers(9) or Chebyshev(9), got {chosen!r}")
    for name, value in switches.items():
        if not isinstance(value, bool):
            raise InputError(f"{name} must be True or False, got {value!r}")
