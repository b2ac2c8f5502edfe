"""Random formulas."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

NAMES = ("a", "b", "c", "j")


def text(numbers: Random, depth: int, names: tuple[str, ...] = (*NAMES, "k")) -> str:
    """A formula with values wherever its names are near 1."""
    if depth == 0:
        return numbers.choice([*names, f"{numbers.uniform(0.1, 3.0):.3g}", "2"])

    def part() -> str:
        return text(numbers, depth - 1, names)

    kinds: list[Callable[[], str]] = [
        *[lambda: f"{part()} {numbers.choice('+-')} {part()}"] * 3,
        *[lambda: f"({part()})*({part()})"] * 2,
        lambda: f"({part()})/(3 + ({part()})^2)",
        lambda: f"-({part()})^{numbers.choice('23')}",
        lambda: f"{numbers.choice(['sin', 'cos', 'atan', 'tanh', 'exp'])}(({part()})/9)",
        lambda: f"sqrt(1 + ({part()})^2)",
        lambda: f"{numbers.choice(['max', 'min', 'norm'])}({part()}, {part()})",
        lambda: f"abs({part()})",
    ]
    return numbers.choice(kinds)()


def convex_text(numbers: Random, depth: int) -> str:
    """A formula of the kinds that the rules of disciplined convex programming speak of.

    Powers and reciprocals are such that their domain is everything: cvxpy leaves the rest of it out unsaid.
    """
    if depth == 0:
        return numbers.choice(["b", "c", "b", "c", f"{numbers.randint(-3, 3)}*b", f"{numbers.randint(-3, 3)}*c", "2"])

    def part() -> str:
        return convex_text(numbers, depth - 1)

    kinds: list[Callable[[], str]] = [
        *[lambda: f"{part()} {numbers.choice('+-')} ({part()})"] * 4,
        *[lambda: f"({numbers.choice([-2, -1, 0.5, 3])})*({part()})"] * 2,
        lambda: numbers.choice([f"({part()})^2", f"({part()})^4", f"abs({part()})^3"]),
        lambda: f"{numbers.choice(['exp', 'abs', 'sqrt', 'log'])}({part()})",
        lambda: f"{numbers.choice(['max', 'min'])}({part()}, {part()})",
        lambda: f"norm({part()}, {part()})",
        lambda: f"1/(2 + ({part()})^2)",
        lambda: f"({part()})*({part()})",
    ]
    return numbers.choice(kinds)()
