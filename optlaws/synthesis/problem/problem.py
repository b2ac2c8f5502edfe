"""The problem to be solved, a frozen value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, fields, replace
from functools import lru_cache
from typing import Any, ClassVar, cast

from optlaws.echo import shortened
from optlaws.entries.declared import Declared, Entry, TableOf, declared, entries_of, entry
from optlaws.entries.value_types import Either, Listed, Number, ReadBy, Switch, Table, Text, Whole, is_list
from optlaws.errors import InputError
from optlaws.files.reading import check_names
from optlaws.kept import kept_property
from optlaws.numbers import MOST_DEGREE, MOST_ORDER
from optlaws.synthesis.problem import fields as of
from optlaws.synthesis.problem.constants import FUNCTIONALS, C_minus, C_plus, Functional
from optlaws.synthesis.problem.expression import Expression, Term, leaves
from optlaws.synthesis.problem.fields import CONSTANTS, AsItFits, ConstantBounds, Field, NotGiven, ProblemTable
from optlaws.synthesis.problem.named_constants import expression
from optlaws.synthesis.problem.ranges import Bounds, Range, as_range
from optlaws.synthesis.problem.windows import Window
from optlaws.synthesis.spaces.bases import Basis, Chebyshev
from optlaws.synthesis.spaces.end_conditions import BoundaryConditions
from optlaws.tolerances import MIRROR

_NAMED = tuple(FUNCTIONALS[name] for name in CONSTANTS)
_NUMBERS = Listed(Number())
_WINDOW = Either(
    ReadBy(dict, "a table", json={"type": "object"}), Text(), which=lambda value: int(isinstance(value, str))
)
_SWITCH = Field(by=of.instance((bool, AsItFits), "True or False"), of=Switch(), write=bool)
_LIMITED = Field(by=of.constant, of=ConstantBounds(), write=of.plain_range, near=of.limited_alike)
_OBJECTIVE = Field(
    by=of.objective,
    of=Text(),
    write=str,
    near=lambda first, second: [term for _, term in first.terms] == [term for _, term in second.terms],
    compared="objective",
)
_BASIS = Field(
    by=of.instance(Basis, "a Basis such as Powers(9) or Chebyshev(9)"),
    of=TableOf(
        "key",
        {
            "basis": entry(
                Text(),
                "Basis of Z(k): powers, chebyshev, bernstein, bsplines, pieces or periodic.",
                default="chebyshev",
            ),
            "degree": entry(
                Whole(most=MOST_DEGREE), "Degree of Z(k), or of the law on each piece.", default=9, label="degree of Z"
            ),
            "breaks": entry(
                Either(Whole(1), Listed(Number(), least=2), which=is_list),
                "For bsplines, pieces and periodic: places from 0 to 1, or how many equal pieces there are.",
                default=None,
                example=[0, 0.3, 1],
            ),
            "continuity": entry(
                Whole(), "For bsplines and pieces: order up to which derivatives are continuous.", default=None
            ),
            "straight": entry(
                _NUMBERS,
                "For periodic: numbers, from 0 on, of the pieces without acceleration.",
                default=None,
                example=[0, 2],
            ),
        },
    ),
    join=of.joined_basis,
    write=lambda basis: basis.to_dict(),
    near=lambda *_: True,  # the solver compares the spaces that the bases span
)
_ENDS = Field(
    by=of.instance(BoundaryConditions, "BoundaryConditions(start, end)"),
    of=TableOf(
        "key",
        {
            "start": entry(
                _NUMBERS,
                "Values of a, b, c, ... at k = 0; rest unless given. Their number is the order.",
                default=None,
                example=[0, 0.5],
            ),
            "end": entry(
                _NUMBERS, "Values of a, b, c, ... at k = 1; rest unless given.", default=None, example=[1, 0.5]
            ),
        },
    ),
    join=of.joined_ends,
    write=of.plain_ends,
)
_BOUNDS = Field(
    by=lambda given, _: Bounds(given),
    of=Table(ConstantBounds()),
    write=lambda bounds: {key.name: r.high if r.fixed else of.plain_range(r) for key, r in bounds.items()} or None,
    near=of.bounded_alike,
)
_WINDOWS = Field(
    by=of.windows,
    of=Listed(_WINDOW),
    join=of.read_windows,
    write=lambda windows: [window.to_dict() for window in windows] or None,
    near=lambda first, second: len(first) == len(second),
)


@declared
class Problem(Declared, title="a problem"):
    """Minimise an objective over the laws (8) with given end conditions and constants (eq. 10); dimensionless.

    Parameters
    ----------
    basis
        Basis of Z(k) with its degree: `Powers(9)`, `Chebyshev(9)`, `BSplines(8, 3)`; `Chebyshev(9)` by default, also
        on the command line.
    symmetric
        Require a(k) + a(1-k) = 1. From rest to rest this does not change the optimum if the objective is convex and
        equal for a law and its mirror image, and there are no windows: the mean of both laws is no worse. The default
        is True; it is False where a minimised or bounded formula differs between a law and its mirror image, such as a
        torque against a load over a: then no symmetric law need be optimal.
    B, C, D, J
        Peak velocity, acceleration, power and jerk: a number fixes the constant, a `Range` such as
        `between(1.5, 1.8)` or `at_most(60)` bounds it, None leaves it free. `at_most` only requires |b| <= B
        everywhere, `at_least` a peak |b| >= B at any k. From rest to rest a number also puts the peak in the middle,
        unless there is an inflexion: b(1/2) is B, the greatest |b|.
    bounds
        Bounds of any constant, by its name or itself: `{"rms_c": at_most(4), "C_minus": at_most(5)}`.
    inflexion
        The k at which b is greatest: b <= b(inflexion) everywhere and c is 0 there, for either sign of b. A fixed or
        lower bounded B is then prescribed for b at this k. Without an inflexion it is k = 1/2 for laws from rest to
        rest with a fixed B, else any k. Symmetric laws can have it at 1/2 only.
    boundary
        End conditions; rest to rest by default. Other conditions make the law unsymmetric.
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

    instead: ClassVar[Mapping[str, str]] = {"degree": "basis=Chebyshev({})"}

    _: KW_ONLY
    minimise: str | Term | Expression = entry(
        _OBJECTIVE,
        "What to minimise: a constant, a sum or maximum of some, or a formula such as rms(c + 3*b).",
        default="C",
        label="minimised",
    )
    order: int = entry(
        Field(by=of.order, of=Whole(1, MOST_ORDER), write=lambda given: given or None),
        "Number l of boundary conditions at each end: 3 for acceleration 0, 4 for jerk 0 too.",
        default=NotGiven(),
        label="order l",
        example=4,
    )
    basis: Basis = entry(_BASIS, "Basis of Z(k) with its degree.", default=Chebyshev(9))
    monotone: bool = entry(_SWITCH, "Require b >= 0: the motion never turns back.", default=False)
    symmetric: bool = entry(
        _SWITCH,
        "Require a(k) + a(1-k) = 1; unless given not of formulas that differ for a law and its mirror image.",
        default=AsItFits(1),
    )
    B: float | Range | None = entry(
        _LIMITED, "Peak velocity, above 1: the mean velocity is 1.", default=None, label="B asked", example=[1.5, 1.8]
    )
    C: float | Range | None = entry(_LIMITED, "Peak acceleration.", default=None, label="C asked")
    D: float | Range | None = entry(_LIMITED, "Peak power.", default=None, label="D asked")
    J: float | Range | None = entry(_LIMITED, "Peak jerk.", default=None, label="J asked")
    bounds: Mapping[Any, Any] = entry(
        _BOUNDS,
        "The same for any constant, also by names with arguments, such as `peak(c - 2*b)`.",
        default=Bounds(),
        example={"rms_c": [0, 4], "snap": [0, 900]},
    )
    inflexion: float | None = entry(
        Field(by=of.inflexion, of=Number()),
        "The k of the peak velocity, where c is 0; of unsymmetric laws.",
        default=None,
        example=0.4,
    )
    boundary: BoundaryConditions | None = entry(_ENDS, "End conditions.", default=None)
    windows: tuple[Window, ...] = entry(
        _WINDOWS,
        "a, b, c, j or a formula in bounds, such as `a = 0.3 @ 0.4` or `c + 0.2*b <= 5`.",
        default=(),
        example=["b <= 1.2 @ 0.2..0.3", {"quantity": "a", "value": 0.3, "at": 0.4}],
    )

    def _check(self) -> None:
        object.__setattr__(self, "order", of.order_with(self.order, self.boundary))
        self._give_bounds_their_entries()
        symmetric: object = self.symmetric
        if isinstance(symmetric, AsItFits):
            object.__setattr__(self, "symmetric", not self.uneven)
        self._put_inflexion_on_a_break()
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
                limits = of.constant_of_bounds(getattr(self, constant.name), self.bounds[constant], constant.name)
                object.__setattr__(self, constant.name, limits)
        others = {constant: limits for constant, limits in self.bounds.items() if constant not in _NAMED}
        object.__setattr__(self, "bounds", Bounds(others))

    def _put_inflexion_on_a_break(self) -> None:
        """A peak beside a break by no more than rounding is at the break: rows between them would be rounding alone."""
        for k in getattr(self.basis, "breaks", ()) if self.inflexion is not None else ():
            if abs(k - self.inflexion) <= MIRROR:
                object.__setattr__(self, "inflexion", k)

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
        velocity = of.constant(B, "B")
        problem.__dict__.update(unchanged, B=velocity, _ranges={**self._ranges, "B": as_range(velocity, "B")})
        return problem

    def to_dict(self) -> dict[str, Any]:
        """The problem as plain data for JSON: entries that every problem has, then those that are no default.

        Examples
        --------
        >>> Problem.from_dict(Problem(B=2, order=3).to_dict()) == Problem(B=2, order=3)
        True
        """
        plain: dict[str, Any] = {}
        for name, field in _FIELDS.items():
            value = getattr(self, name)
            written = None if value is None else field.plain(value)
            if written is not None:
                plain |= written if field.parts else {name: written}
        return plain

    @classmethod
    def tables(cls) -> Mapping[str, Mapping[str, Any]]:
        """The entries as files have them, by ""."""
        return {"": ENTRIES}

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
        return [*_ALWAYS, *(entry.name for entry in fields(self) if entry.name in given and entry.name not in _ALWAYS)]


#: what a problem always says
_ALWAYS = ("B", "order", "basis", "minimise")
#: what a number for B has no part in
_UNCHANGED_ALONG_B = {entry.name for entry in fields(Problem)} | {"objective", "convex", "constants", "bounded"}
_FIELDS = {name: cast("Field", each.type) for name, each in entries_of(Problem).items()}
#: in the order in which files name them
_IN_FILES = ("minimise", *CONSTANTS, "order", "bounds", "inflexion", "basis", "monotone", "symmetric", "boundary",
             "windows")  # fmt: skip


def _entries_of_files() -> dict[str, Entry]:
    known: dict[str, Entry] = {}
    for name in _IN_FILES:
        field, each = _FIELDS[name], entries_of(Problem)[name]
        known |= field.parts or {name: replace(each, type=field.of, default=each.plain_default)}
    return known


#: the entries of files, where those without a default ask nothing unless given
ENTRIES = _entries_of_files()
PROBLEM = ProblemTable("key", ENTRIES)
#: lists of what entries are in turn, several in one table at a time
SWEPT = ProblemTable(
    "key",
    {
        name: replace(each, type=Listed(each.type, least=1), default=None, example=None)
        for name, each in ENTRIES.items()
    },
)


def from_entries(data: Mapping[str, Any]) -> dict[str, Any]:
    """What `Problem` takes of the entries of a file.

    >>> from_entries({"order": 4, "degree": 5})
    {'order': 4, 'basis': Chebyshev(degree=5)}
    """
    if not isinstance(data, Mapping):
        raise InputError(f"a problem must be a table of entries such as order and B, got {shortened(data)}")
    check_names(data, ENTRIES, PROBLEM.what)
    if "order" not in data and "start" not in data:
        raise InputError(of.NO_ORDER)
    given: dict[str, Any] = {}
    for name, field in _FIELDS.items():
        given |= field.given(data, name)
    return given


def differ_in_numbers(first: Problem, second: Problem) -> bool:
    """Whether two problems differ at most in numbers along which warm starts run, and in their bases."""
    compared = ((field, field.compared or name) for name, field in _FIELDS.items())
    return all(field.near(getattr(first, name), getattr(second, name)) for field, name in compared)


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
