"""The problem to be solved, a frozen value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from optlaws.errors import InputError
from optlaws.laws.checks import whole
from optlaws.suggest import unknown_key
from optlaws.synthesis.bases import Basis, Chebyshev, basis


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Minimise a peak constant of a law (8) that starts and ends at rest, at a given peak velocity B (eq. 10).

    All quantities are dimensionless. The law has l = `order` conditions at each end (a, b, c, ... = 0, 0, 0, ... at
    k = 0 and 1, 0, 0, ... at k = 1), b(1/2) = B and b <= B everywhere.

    Parameters
    ----------
    B
        Peak velocity, above 1.
    order
        Number l of boundary conditions at each end, at least 1.
    basis
        Basis of Z(k) with its degree: `Powers(9)`, `Chebyshev(9)`.
    minimise
        The constant to minimise: "C".
    monotone
        Ask b >= 0 too.
    symmetric
        Ask a(k) + a(1-k) = 1. The optimum is the same either way (the problem is convex, so the mean of a solution and
        its mirror image is no worse); with False the lower bound speaks of unsymmetric laws as well.

    Raises
    ------
    InputError
        If a value is out of range, or the degree leaves Z no freedom.

    Examples
    --------
    >>> Problem(B=1.859, order=4, basis=Chebyshev(9))
    Problem(B=1.859, order=4, basis=Chebyshev(degree=9), minimise='C', monotone=False, symmetric=True)
    """

    B: float
    order: int
    basis: Basis = field(default_factory=lambda: Chebyshev(9))
    minimise: str = "C"
    monotone: bool = False
    symmetric: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "B", _peak_velocity(self.B))
        object.__setattr__(self, "order", whole(self.order, "order", least=1))
        _check_choices(self.basis, self.minimise, monotone=self.monotone, symmetric=self.symmetric)
        if self.basis.degree < 1:
            raise InputError(
                f"degree {self.basis.degree} leaves no freedom: b(1/2) = B takes the one coefficient of Z that is "
                "odd about k = 1/2, so the degree of Z must be at least 1 (3 or more to optimise)"
            )

    @property
    def terms(self) -> int:
        """Number of coefficients of Z that are odd about k = 1/2."""
        return (self.basis.degree + 1) // 2

    def to_dict(self) -> dict[str, Any]:
        """Plain JSON-able dict.

        Examples
        --------
        >>> Problem.from_dict(Problem(B=2, order=3).to_dict()) == Problem(B=2, order=3)
        True
        """
        return {
            "minimise": self.minimise,
            "B": self.B,
            "order": self.order,
            "basis": self.basis.name,
            "degree": self.basis.degree,
            "monotone": self.monotone,
            "symmetric": self.symmetric,
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Problem:
        """Read a problem from what `to_dict` wrote, or a part of it: B and order are needed.

        Raises
        ------
        InputError
            If a key is unknown (the nearest right one is named) or missing, or a value is out of range.
        """
        known = ("minimise", "B", "order", "basis", "degree", "monotone", "symmetric")
        for key in data:
            if key not in known:
                raise InputError(unknown_key(key, known))
        missing = [key for key in ("B", "order") if key not in data]
        if missing:
            raise InputError(f"the problem lacks {' and '.join(missing)}")
        given = dict(data)
        chosen = basis(given.pop("basis", "chebyshev"), given.pop("degree", 9))
        return cls(basis=chosen, **given)


def _peak_velocity(B: Any) -> float:  # noqa: ANN401 - it is checked here
    if isinstance(B, bool) or not isinstance(B, int | float) or not isfinite(B) or B <= 1:
        raise InputError(f"B must be a finite number above 1 (the mean velocity is 1), got {B!r}")
    return float(B)


def _check_choices(chosen: Any, minimise: Any, **switches: Any) -> None:  # noqa: ANN401 - they are checked here
    if not isinstance(chosen, Basis):
        raise InputError(f"basis must be a Basis such as Powers(9) or Chebyshev(9), got {chosen!r}")
    if minimise != "C":
        raise InputError(f"minimise must be 'C', got {minimise!r}")
    for name, value in switches.items():
        if not isinstance(value, bool):
            raise InputError(f"{name} must be True or False, got {value!r}")
