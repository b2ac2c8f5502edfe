"""The problem to be solved, a frozen value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from typing import Any

from optlaws.errors import InputError
from optlaws.files.reading import JsonText
from optlaws.kept import kept_property
from optlaws.numbers import MOST_ORDER
from optlaws.synthesis.problem.checks import AS_IT_FITS, NotGiven, constant_of_bounds, is_open, order_with
from optlaws.synthesis.problem.constants import FUNCTIONALS, C_minus, C_plus, Functional
from optlaws.synthesis.problem.expression import Expression, Term, leaves
from optlaws.synthesis.problem.fields import CONSTANTS, FIELDS, from_entries, to_entries
from optlaws.synthesis.problem.named_constants import expression
from optlaws.synthesis.problem.ranges import Bounds, Range, as_range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.bases import Basis, Chebyshev
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions

_NAMED = tuple(FUNCTIONALS[name] for name in CONSTANTS)


@dataclass(frozen=True, kw_only=True, repr=False)
class Problem(JsonText):
    """Minimise an objective over the laws (8) with given end conditions and constants (eq. 10); dimensionless.

    Parameters
    ----------
    order
        Number l of boundary conditions at each end, at least 1.
    minimise
        A constant or a sum or maximum of constants: "C", "D", "0.6*C/4 + 0.4*D/2.25", `0.6 * C / 4 + 0.4 * D / 2.25`.
    B, C, D, J
        Peak velocity, acceleration, power and jerk: a number fixes the constant, a `Range` such as
        `between(1.5, 1.8)` or `at_most(60)` bounds it, None leaves it free. `at_most` only requires |b| <= B
        everywhere, `at_least` a peak |b| >= B at any k. From rest to rest a number also puts the peak in the middle,
        unless there is an inflexion: b(1/2) is B, the greatest |b|.
    bounds
        Bounds of any constant, by its name or itself: `{"rms_c": at_most(4), "C_minus": at_most(5)}`.
    basis
        Basis of Z(k) with its degree: `Powers(9)`, `Chebyshev(9)`, `BSplines(8, 3)`; `Chebyshev(9)` by default, also
        on the command line.
    monotone
        Require b >= 0.
    symmetric
        Require a(k) + a(1-k) = 1. From rest to rest this does not change the optimum if the objective is convex and
        equal for a law and its mirror image, and there are no windows: the mean of both laws is no worse. The default
        is True; it is False where a minimised or bounded formula differs between a law and its mirror image, such as a
        torque against a load over a: then no symmetric law need be optimal.
    boundary
        End conditions; rest to rest by default. Other conditions make the law unsymmetric.
    inflexion
        The k at which b is greatest: b <= b(inflexion) everywhere and c is 0 there, for either sign of b. A fixed or
        lower bounded B is then prescribed for b at this k. Without an inflexion it is k = 1/2 for laws from rest to
        rest with a fixed B, else any k. Symmetric laws can have it at 1/2 only.
    windows
        Values and windows of a, b, c, j or formulas: `via("a", 0.3, at=0.4)`, `Window("c + 2*b", high=5, start=0.2)`.

    Raises
    ------
    InputError
        If a value is out of range, or the degree leaves Z no freedom.

    Examples
    --------
    >>> Problem(B=1.859, order=4, basis=Chebyshev(9))
    Problem(B=1.859, order=4, basis=Chebyshev(degree=9), minimise='C')
    """

    _json_name = "a problem"

    B: float | Range | None = None
    order: int = NotGiven()
    basis: Basis = field(default_factory=lambda: Chebyshev(9))
    minimise: str | Term | Expression = "C"
    monotone: bool = False
    symmetric: bool = AS_IT_FITS
    C: float | Range | None = None
    D: float | Range | None = None
    J: float | Range | None = None
    boundary: BoundaryConditions | None = None
    windows: tuple[Window, ...] = ()
    bounds: Mapping[Any, Any] = Bounds()
    inflexion: float | None = None

    def __post_init__(self) -> None:
        for entry in FIELDS:
            object.__setattr__(self, entry.name, entry.check(getattr(self, entry.name)))
        object.__setattr__(self, "order", order_with(self.order, self.boundary))
        self._give_bounds_their_entries()
        if is_open(self.symmetric):
            object.__setattr__(self, "symmetric", not self.uneven)
        if self.symmetric and self.inflexion not in {None, 0.5}:
            raise InputError(
                f"a symmetric law has its inflexion at 1/2, not at {self.inflexion!r}: give symmetric=False"
            )
        self._drop_implied_inflexion()
        if self.boundary is not None:
            if self.boundary == BoundaryConditions.rest(self.order):
                object.__setattr__(self, "boundary", None)
            elif self.symmetric:
                raise InputError("a law with these boundary conditions is not symmetric: give symmetric=False")
        self.basis.check(symmetric=self.symmetric)

    def _give_bounds_their_entries(self) -> None:
        """Move bounds of B, C, D and J to the entries of these names."""
        for constant in _NAMED:
            if constant in self.bounds:
                limits = constant_of_bounds(getattr(self, constant.name), self.bounds[constant], constant.name)
                object.__setattr__(self, constant.name, limits)
        others = {constant: limits for constant, limits in self.bounds.items() if constant not in _NAMED}
        object.__setattr__(self, "bounds", Bounds(others))

    def _drop_implied_inflexion(self) -> None:
        """Equivalent problems are equal: for symmetric laws a fixed B may imply the peak in the middle."""
        if self.symmetric and self.inflexion is not None and _fixed_above_mean(as_range(self.B, "B")):
            object.__setattr__(self, "inflexion", None)

    @kept_property
    def objective(self) -> Expression:
        """The constants that are minimised, with their weights."""
        return expression(self.minimise) if isinstance(self.minimise, str) else self.minimise.expression()

    @property
    def conditions(self) -> BoundaryConditions:
        """The conditions at both ends of the motion."""
        return self.boundary if self.boundary is not None else _at_rest(self.order)

    @kept_property
    def convex(self) -> bool:
        """Whether every constant in the objective and every bounded one is convex in the law, and every window."""
        return all(window.convex for window in self.windows) and all(constant.convex for constant in self.constants)

    @property
    def mirrored(self) -> bool:
        """Whether unsymmetric laws are sought although every bound of symmetric laws holds for them too.

        Where the objective is convex the mean of a law and its mirror image is no worse; where D is in it, that is
        so for the relaxed program.
        """
        even = all(
            FUNCTIONALS.get(constant.name) == constant and constant not in {C_plus, C_minus}
            for constant in self.constants
        )
        plain = self.boundary is None and not self.windows and self.basis.mirrored and self.inflexion is None
        return not self.symmetric and plain and even

    @property
    def peak_at(self) -> float | None:
        """The k at which b is required to be greatest and c is 0; None where the peak is free."""
        if self.inflexion is not None:
            return self.inflexion
        return 0.5 if self.boundary is None and _fixed_above_mean(self.range("B")) else None

    @property
    def peak_is_variable(self) -> bool:
        """Whether programs have a variable B for a prescribed peak velocity, besides the objective's variables."""
        limits = self.range("B")
        if limits is None:
            return False
        return not self.symmetric if limits.fixed else limits.low > 0.0 and self.peak_at is not None

    def range(self, name: str) -> Range | None:
        """The range of a constant, by its name."""
        return self._ranges.get(name)

    @kept_property
    def bounded(self) -> tuple[tuple[Functional, Range], ...]:
        """The bounded constants except B, with their bounds."""
        of_entries = ((constant, self._ranges[constant.name]) for constant in _NAMED if constant.name != "B")
        return (*((constant, limits) for constant, limits in of_entries if limits is not None), *self.bounds.items())

    @kept_property
    def _ranges(self) -> dict[str, Range | None]:
        of_entries = {name: as_range(getattr(self, name), name) for name in CONSTANTS}
        return of_entries | {constant.name: limits for constant, limits in self.bounds.items()}

    @kept_property
    def constants(self) -> set[Functional]:
        """The constants in the objective and the bounded ones."""
        minimised = {leaf for _, leaf in leaves(self.objective) if isinstance(leaf, Functional)}
        return minimised | {constant for constant, _ in self.bounded}

    @property
    def uneven(self) -> list[Functional]:
        """The names of constants that differ between a law and its mirror image.

        Examples
        --------
        >>> problem = Problem(order=4, minimise="rms(c + 4*a)")
        >>> problem.uneven, problem.symmetric
        ([rms(c + 4*a)], False)
        """
        return sorted((constant for constant in self.constants if not constant.even), key=repr)

    @kept_property
    def shape(self) -> Problem:
        """The problem with a fixed B replaced by 2: problems of one shape share their program."""
        return replace(self, B=2.0) if isinstance(self.B, float) and self.B != 2.0 else self

    def at_velocity(self, B: float) -> Problem:
        """The problem with another number for B; where it has one already, in a tenth of the time of `replace`.

        Raises
        ------
        InputError
            If it is no number that B can be.

        Examples
        --------
        >>> Problem(B=1.6, order=4).at_velocity(1.7)
        Problem(B=1.7, order=4, basis=Chebyshev(degree=9), minimise='C')
        """
        if not isinstance(self.B, float) or self.inflexion is not None or type(self) is not Problem:
            return replace(self, B=B)
        problem: Problem = object.__new__(Problem)
        unchanged = {name: value for name, value in self.__dict__.items() if name in _UNCHANGED_ALONG_B}
        velocity = _check_velocity(B)
        problem.__dict__.update(unchanged, B=velocity, _ranges={**self._ranges, "B": as_range(velocity, "B")})
        return problem

    def to_dict(self) -> dict[str, Any]:
        """The problem as plain data for JSON.

        Examples
        --------
        >>> Problem.from_dict(Problem(B=2, order=3).to_dict()) == Problem(B=2, order=3)
        True
        """
        return to_entries(self)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Problem:
        """Read a problem from what `to_dict` wrote, or a part of it: the order is needed.

        Raises
        ------
        InputError
            If a key is unknown (the nearest right one is named) or missing, or a value is out of range.
        """
        return cls(**from_entries(data))

    @kept_property
    def _titles(self) -> dict[str, str]:
        """Titles of the constants that are not called by their names, by these."""
        named = sorted(self.constants, key=lambda constant: constant.name)
        return {titled.name: titled.title for titled in named if titled.title != titled.name}

    def titled(self, text: str) -> str:
        """A text in which the problem's constants have their titles, which are short, in place of their names.

        Examples
        --------
        >>> Problem(order=4).titled("the least C")
        'the least C'
        """
        for name, title in self._titles.items():
            text = text.replace(repr(name), repr(title)).replace(repr(name)[1:-1], title).replace(name, title)
        return text

    @property
    def as_code(self) -> str:
        """Python code of the problem: its repr, with long names of constants written once, after it.

        Examples
        --------
        >>> Problem(B=1.859, order=4).as_code
        "Problem(B=1.859, order=4, basis=Chebyshev(degree=9), minimise='C')"
        """
        short = {name: f"constant_{i}" for i, name in enumerate(self._titles, 1)}
        values = {name: getattr(self, name) for name in self._shown}
        texts = {name: repr(value) for name, value in values.items()}
        if isinstance(self.minimise, str):
            texts["minimise"] = _as_code(texts["minimise"], short)
        if "bounds" in texts:
            texts["bounds"] = _as_code(texts["bounds"], short)
        code = f"Problem({', '.join(f'{name}={text}' for name, text in texts.items())})"
        return "\n".join([code, *(f"where {abbreviation} = {name!r}" for name, abbreviation in short.items())])

    def _repr_html_(self) -> str:
        from optlaws.shown.showing import facts, page

        given = {name: getattr(self, name) for name in self._shown}
        texts = {name: "free" if value is None else self.titled(str(value)) for name, value in given.items()}
        return page("Problem", facts(texts))

    def __repr__(self) -> str:
        return f"Problem({', '.join(f'{name}={getattr(self, name)!r}' for name in self._shown)})"

    @property
    def _shown(self) -> list[str]:
        """The entries of the problem's text: some always, others where they are given."""
        given = {entry.name for entry in fields(self) if getattr(self, entry.name) != entry.default}
        if self.symmetric and self.uneven:
            # an explicit symmetry differs from the default
            given.add("symmetric")
        return [entry.name for entry in fields(self) if entry.name in _ALWAYS or entry.name in given]


#: what a problem always says
_ALWAYS = ("B", "order", "basis", "minimise")
_check_velocity = next(field.check for field in FIELDS if field.name == "B")
#: what a number for B has no part in
_UNCHANGED_ALONG_B = {entry.name for entry in fields(Problem)} | {"objective", "convex", "constants", "bounded"}


def _fixed_above_mean(limits: Range | None) -> bool:
    """Whether B is fixed, to a value that laws with stroke 1 can have as the peak of their velocity alone."""
    return limits is not None and limits.fixed and limits.low > 1.0


def _as_code(code: str, short: Mapping[str, str]) -> str:
    """Python in which variables stand for texts that are long names, and for these within a text."""
    for name, text in short.items():
        code = code.replace(repr(name), text).replace(repr(name)[1:-1], f"{{{text}}}")
    return f"f{code}" if code.startswith(("'", '"')) and "{" in code else code


@lru_cache(maxsize=MOST_ORDER)
def _at_rest(order: int) -> BoundaryConditions:
    return BoundaryConditions.rest(order)
