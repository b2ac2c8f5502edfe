"""What a solution of any problem claims, judged by numpy.polynomial from the stored law alone."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import inf, isfinite, sqrt
from typing import Any

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from optlaws import Expression, Functional, MotionLaw, Problem, Range, Solution, Window, peak
from optlaws.synthesis import Maximum
from tests.formulas.by_python import by_python
from tests.internals.formulas import MotionFormula, Table
from tests.internals.mechanisms import BandResidual, CamPeak, CamPower, ModeResidual, OutputConstant
from tests.internals.synthesis import FormulaIntegral, FormulaPeak, FormulaRms, FormulaValue, OfFormula, leaves
from tests.mechanisms.machine.stepped import machine_value, residual_rounding
from tests.synthesis.independent import DENSE

Array = NDArray[np.float64]

#: constants of one derivative, by its order
PEAKS = {"B": 1, "C": 2, "J": 3, "snap": 4}
SQUARES = {"rms_c": 2, "rms_j": 3, "rms_snap": 4}


@dataclass(frozen=True)
class Curve:
    """A function of k: a numpy series on each piece of [0, 1]."""

    pieces: tuple[Chebyshev, ...]

    def __call__(self, k: Any) -> Any:
        """The value, at a break that of the piece that begins there."""
        places = np.asarray(k, dtype=float)
        begins = np.array([piece.domain[0] for piece in self.pieces])
        index = np.clip(np.searchsorted(begins, places, side="right") - 1, 0, len(begins) - 1)
        values = np.choose(index, [piece(places) for piece in self.pieces])
        return float(values) if values.ndim == 0 else values

    def slope(self) -> "Curve":
        return Curve(tuple(piece.deriv() for piece in self.pieces))

    def whole(self, start: float) -> "Curve":
        """The integral, continuous."""
        found = []
        for piece in self.pieces:
            low, high = piece.domain
            found.append(piece.integ(lbnd=low) + start)
            start = float(found[-1](high))
        return Curve(tuple(found))

    def extremes(self) -> tuple[float, float]:
        """Least and greatest value: a dense grid, the stationary points and both sides of every break."""
        ends = [_extremes(piece, piece) for piece in self.pieces]
        return min(low for low, _ in ends), max(high for _, high in ends)

    def within(self, start: float, stop: float) -> tuple[float, float]:
        """Least and greatest value on an interval, both sides of a break at its ends' insides."""
        found = [float(self(start)), float(self(stop))]
        for piece in self.pieces:
            low, high = max(start, piece.domain[0]), min(stop, piece.domain[1])
            if low < high:
                slope = piece.deriv().trim()
                inner = np.real(slope.roots()) if len(slope.coef) > 1 else np.empty(0)
                places = np.concatenate([low + (high - low) * DENSE, inner[(inner > low) & (inner < high)]])
                found += [float(piece(places).min()), float(piece(places).max())]
        return min(found), max(found)

    def mean_square(self) -> float:
        """By the exact integral."""
        return sum(float((piece**2).integ(lbnd=piece.domain[0])(piece.domain[1])) for piece in self.pieces)


def _extremes(first: Chebyshev, second: Chebyshev) -> tuple[float, float]:
    """Of a series, or of the product of two, whose factors are multiplied at its stationary points: it cancels."""
    low, high = first.domain
    slope = (first if first is second else first * second).deriv().trim()
    inner = np.real(slope.roots()) if len(slope.coef) > 1 else np.empty(0)
    k = np.concatenate([low + (high - low) * DENSE, inner[(inner > low) & (inner < high)]])
    values = first(k) if first is second else first(k) * second(k)
    return float(values.min()), float(values.max())


@dataclass(frozen=True)
class Judged:
    """A law as numpy series, and its constants over the whole interval."""

    law: MotionLaw

    @cached_property
    def derivatives(self) -> list[Curve]:
        """a, b, c, c', c''."""
        stored = self.law.to_dict()
        breaks = stored.get("breaks", [0.0, 1.0])
        segments = stored.get("segments", [stored])
        c = Curve(
            tuple(
                Chebyshev(np.array([*segment["acceleration"], 0.0, 0.0]), domain=ends)
                for segment, ends in zip(segments, pairwise(breaks), strict=True)
            )
        )
        b = c.whole(segments[0]["b0"])
        return [b.whole(stored["a0"]), b, c, c.slope(), c.slope().slope()]

    def peak(self, nu: int) -> float:
        """Greatest magnitude."""
        return float(max(np.abs(self.derivatives[nu].extremes())))

    def rms(self, nu: int) -> float:
        """Root of the mean square."""
        return sqrt(self.derivatives[nu].mean_square())

    def constant(self, name: str) -> float:
        """One that has a name of its own, as `C` or `rms_c`."""
        if name in PEAKS:
            return self.peak(PEAKS[name])
        if name in SQUARES:
            return self.rms(SQUARES[name])
        if name == "D":
            both = zip(self.derivatives[1].pieces, self.derivatives[2].pieces, strict=True)
            return max(float(np.abs(_extremes(b, c)).max()) for b, c in both)
        low, high = self.derivatives[2].extremes()
        return {"C_plus": high, "C_minus": -low}[name]

    def value(self, constant: Functional) -> float:
        """Any constant there is, those of a cam and of a follower too."""
        if isinstance(constant, CamPeak):
            low, high = self.cam(constant.frequency, constant.damping)[constant.nu].extremes()
            return max(sign * end for sign in constant.signs for end in (low, high))
        if isinstance(constant, CamPower):
            _, b, c, *_ = self.cam(constant.frequency, constant.damping)
            pieces = zip(b.pieces, c.pieces, strict=True)
            return max(float(np.abs(_extremes(first, second)).max()) for first, second in pieces)
        if isinstance(constant, BandResidual):
            return self.residual(constant)
        if isinstance(constant, OfFormula):
            return self.of_formula(constant)
        if isinstance(constant, OutputConstant | ModeResidual):
            return float(machine_value(constant, self.derivatives[0].pieces))
        return self.constant(constant.name)

    def cam(self, frequency: float, damping: float) -> list[Curve]:
        """Derivatives of the cam law a + 2 damping b/frequency + c/frequency² from order 0 on, up to the jerk."""
        a = self.derivatives
        a = [*a, a[4].slope()]
        once, twice = 2.0 * damping / frequency, 1.0 / frequency**2
        return [
            Curve(
                tuple(
                    x + once * y + twice * z
                    for x, y, z in zip(a[i].pieces, a[i + 1].pieces, a[i + 2].pieces, strict=True)
                )
            )
            for i in range(4)
        ]

    def residual(self, constant: BandResidual) -> float:
        """The amplitude that the follower's free vibration has at k = 1, or nu² times it, greatest over frequencies."""
        b = self.derivatives[1]
        if constant.design is not None:
            b = self.cam(constant.design, constant.design_damping)[1]
        x, weights = np.polynomial.legendre.leggauss(120)
        ends = [piece.domain for piece in b.pieces]
        k = np.concatenate([low + (high - low) * (x + 1.0) / 2.0 for low, high in ends])
        measure = np.concatenate([(high - low) / 2.0 * weights for low, high in ends])
        velocity = (
            np.concatenate([piece(k[i * len(x) : (i + 1) * len(x)]) for i, piece in enumerate(b.pieces)]) * measure
        )

        def size(nu: float) -> float:
            w = complex(-constant.damping * nu, nu * sqrt(1.0 - constant.damping**2))
            unit = 1.0 if constant.displacement else nu**2
            return float(abs(unit * w.conjugate() / w.imag * (np.exp(w * (1.0 - k)) @ velocity)))

        if constant.low == constant.high:
            return size(constant.low)
        places = np.linspace(constant.low, constant.high, 61)
        sizes = [size(nu) for nu in places]
        best = int(np.argmax(sizes))
        around = (places[max(best - 1, 0)], places[min(best + 1, 60)])
        finer = minimize_scalar(lambda nu: -size(nu), bounds=around, method="bounded", options={"xatol": 1e-9})
        return max(*sizes, -float(finer.fun))

    def signal(self, text: str) -> Callable[[Any], Any]:
        """A formula along the law, by Python's own grammar."""

        def values(k: Any) -> Any:
            names = {name: self.derivatives[nu](k) for nu, name in enumerate("abcj")}
            return by_python(text, {**names, "k": k}) + 0.0 * np.asarray(k)

        return values

    def of_formula(self, constant: OfFormula) -> float:
        """By Python's own grammar of the formula's text: a fine grid, and searches about its best places."""
        motion = constant.motion
        signal = self.signal(str(motion.formula))
        edges = sorted(
            {motion.start, motion.stop, *(k for k in self._breaks(motion) if motion.start < k < motion.stop)}
        )
        if isinstance(constant, FormulaValue):
            return float(signal(motion.start))
        if isinstance(constant, FormulaRms):
            x, weights = np.polynomial.legendre.leggauss(80)
            total = sum(
                float(weights @ signal(low + (high - low) * (1.0 + x) / 2.0) ** 2) * (high - low) / 2.0
                for low, high in pairwise(edges)
            )
            return sqrt(total / (motion.stop - motion.start))
        if isinstance(constant, FormulaIntegral):
            x, weights = np.polynomial.legendre.leggauss(80)
            return sum(
                float(weights @ signal(low + (high - low) * (1.0 + x) / 2.0)) * (high - low) / 2.0
                for low, high in pairwise(edges)
            )
        assert isinstance(constant, FormulaPeak)
        return max(self._highest(signal, sign, edges) for sign in constant.signs)

    def _breaks(self, motion: MotionFormula) -> list[float]:
        """Of the law, and of the tables, by their places."""
        own = [piece.domain[0] for piece in self.derivatives[2].pieces]
        return own + [x for part in motion.formula.different if isinstance(part, Table) for x in part.places]

    @staticmethod
    def _highest(signal: Callable[[Any], Any], sign: float, edges: list[float]) -> float:
        found = [sign * float(signal(edges[0]))]
        for low, high in pairwise(edges):
            if high - low < 2.0**-48:
                # an end of the stretch that is a break but for rounding
                continue
            k = np.linspace(low + 2.0**-50, high - 2.0**-50, 801)
            values = sign * signal(k)
            found.append(float(values.max()))
            for best in np.argsort(values)[-3:]:
                around = (k[max(best - 1, 0)], k[min(best + 1, 800)])
                finer = minimize_scalar(lambda at: -sign * float(signal(at)), bounds=around, method="bounded")
                found.append(-float(finer.fun))
        return max(found)

    def worth(self, expression: Expression) -> float:
        """The objective."""
        total = 0.0
        for weight, term in expression.terms:
            if isinstance(term, Maximum):
                total += weight * max(self.worth(part) for part in term.parts)
            else:
                assert isinstance(term, Functional)
                total += weight * self.value(term)
        return total


def broken(problem: Problem, law: MotionLaw, allowed: float = 1e-8) -> list[str]:
    """The constraints of the problem that the law breaks by more than `allowed`, relative to what is asked."""
    judged = Judged(law)
    b = judged.derivatives[1]
    found = [] if problem.boundary is None else ends_broken(problem, judged)
    if problem.boundary is None:
        found += rest_broken(problem.order, judged)
    if problem.symmetric:
        off = float(np.abs(judged.derivatives[0](DENSE) + judged.derivatives[0](1.0 - DENSE) - 1.0).max())
        found += [f"symmetry by {off:.1e}"] * (off > 1e-11)
    found += continuity_broken(problem, judged)
    lowest, _ = b.extremes()
    if problem.monotone and lowest < -allowed:
        found.append(f"b >= 0 by {-lowest:.1e}")
    found += velocity_broken(problem, judged, allowed)
    for constant, asked in problem.bounded:
        value = float(judged.value(constant))
        hidden = residual_rounding(constant) if isinstance(constant, ModeResidual) else 0.0
        found += [f"{constant.name} = {value!r} over {asked!r}"] * (value > asked.high * (1.0 + allowed) + hidden)
        lacks = asked.low > 0.0 and value < asked.low * (1.0 - allowed) - hidden
        found += [f"{constant.name} = {value!r} under {asked!r}"] * lacks
    for window in problem.windows:
        found += window_broken(window, judged, allowed)
    return found


def window_broken(window: Window, one: Judged, allowed: float) -> list[str]:
    """What of a window the law leaves."""
    if window.quantity in "abcj":
        curve = one.derivatives["abcj".index(window.quantity)]
        lowest, highest = curve.within(window.start, window.stop)
        size = max(1.0, *map(abs, curve.extremes()))
    else:
        ends = {"start": window.start, "stop": window.stop}
        highest = one.value(peak(window.quantity, side="high", **ends)) if isfinite(window.high) else -inf
        lowest = -one.value(peak(window.quantity, side="low", **ends)) if isfinite(window.low) else inf
        size = max(abs(end) for end in (window.low, window.high, highest, lowest) if isfinite(end))
    found = [f"{window!r} by {highest - window.high:.1e} above"] * (highest > window.high + allowed * size)
    return found + [f"{window!r} by {window.low - lowest:.1e} below"] * (lowest < window.low - allowed * size)


def continuity_broken(problem: Problem, one: Judged) -> list[str]:
    """Jumps of derivatives that the basis says are continuous at its breaks."""
    found = []
    for nu in range(2, min(getattr(problem.basis, "continuity", 4), 4) + 1):
        curve = one.derivatives[nu]
        size = max(1.0, *map(abs, curve.extremes()))
        for left, right in pairwise(curve.pieces):
            jump = abs(float(left(left.domain[1]) - right(right.domain[0])))
            if jump > 1e-9 * size:
                found.append(f"derivative {nu} jumps by {jump:.1e} at {right.domain[0]:g}")
    return found


def as_range(value: float | Range | None) -> Range | None:
    """A number as a Range."""
    return value if value is None or isinstance(value, Range) else Range(float(value), float(value))


def peak_in_the_middle(problem: Problem) -> bool:
    """Whether what is asked of B places the peak velocity: a number does, and every rise has a B above 1."""
    expected = as_range(problem.B)
    plain = problem.inflexion is None and problem.boundary is None
    return plain and expected is not None and expected.low == expected.high and expected.low > 1.0


def velocity_broken(problem: Problem, one: Judged, allowed: float) -> list[str]:
    """What a law does that is not asked of its velocity.

    A number places the peak at k = 1/2 between rests, an inflexion wherever it says. An upper end holds for |b|
    everywhere, a lower one for the greatest |b|, and they place nothing.
    """
    expected = as_range(problem.B)
    b, c = one.derivatives[1:3]
    lowest, highest = b.extremes()
    place = problem.inflexion
    if place is None and peak_in_the_middle(problem):
        place = 0.5
    peak = max(highest, -lowest)
    found = []
    if place is not None:
        value, size = float(b(place)), max(1.0, peak)
        bend = abs(float(c(place)))
        found += [f"c({place:g}) = {bend:.1e}"] * (bend > 1e-9 * max(1.0, *map(abs, c.extremes())))
        found += [f"b <= b({place:g}) by {highest - value:.1e}"] * (highest > value + allowed * size)
        peak = peak if expected is not None and not expected.fixed and expected.high < inf else value
    if expected is None:
        return found
    found += [f"B = {peak!r} over {expected!r}"] * (peak > expected.high * (1.0 + allowed))
    least = peak if place is None else float(b(place))
    return found + [f"B = {least!r} under {expected!r}"] * (least < expected.low * (1.0 - allowed))


def rest_broken(order: int, one: Judged) -> list[str]:
    """From 0 to 1, at rest to the order."""
    a, *derivatives = one.derivatives
    found = [f"a{k}" for k, value in ((0.0, 0.0), (1.0, 1.0)) if abs(a(k) - value) > 1e-11]
    for nu, series in enumerate(derivatives[: order - 1], 1):
        size = float(np.abs(series(DENSE)).max())
        found += [f"derivative {nu} at {k}" for k in (0.0, 1.0) if abs(series(k)) > 1e-9 * size]
    return found


def ends_broken(problem: Problem, one: Judged) -> list[str]:
    """The values asked at the ends."""
    assert problem.boundary is not None
    found = []
    for k, values in ((0.0, problem.boundary.start), (1.0, problem.boundary.end)):
        for nu, value in enumerate(values[:5]):
            series = one.derivatives[nu]
            size = max(1.0, float(np.abs(series(DENSE)).max()))
            if abs(series(k) - float(value)) > 1e-9 * size:
                found.append(f"derivative {nu} at {k}: {series(k)!r} for {value!r}")
    return found


def judge(solution: Solution) -> None:
    """Everything a solution claims."""
    problem = solution.problem
    found = broken(problem, solution.law)
    assert found == [], f"{found}: {problem!r}"
    worth = Judged(solution.law).worth(problem.objective)
    # an objective that is 0 but for rounding is judged by what it is made of
    scale = problem.objective.scale
    nothing = 0.0 if abs(worth) > 1e-6 * scale else 1e-9 * scale
    # amplitudes that a mode leaves are sums that cancel
    amplitudes = [weight * term.scale for weight, term in leaves(problem.objective) if isinstance(term, ModeResidual)]
    nothing = max(nothing, 1e-10 * max(amplitudes, default=0.0))
    assert abs(worth - solution.objective) <= 1e-9 * abs(worth) + nothing, f"{worth!r} is not {solution.objective!r}"
    # an amplitude that is next to nothing is known to a rounding of what it is a difference of
    hidden = 1e-12 * max(amplitudes, default=0.0)
    assert solution.lower_bound <= solution.objective + 1e-11 * abs(solution.objective) + hidden, problem
    assert solution.lower_bound == max(
        solution.certificate.bound, -inf if solution.best_possible is None else solution.best_possible
    ), problem
    status = solution.status.value
    assert status in {"optimal", "local"}, f"{status}: {problem!r}"
    if status == "optimal":
        assert abs(solution.gap) <= 1e-8, problem
    else:
        assert not problem.convex or lower_bounded(problem), f"local though convex: {problem!r}"
    if solution.starts:
        assert list(solution.starts) == sorted(solution.starts)
        assert solution.starts[0] == solution.objective


def lower_bounded(problem: Problem) -> bool:
    """Whether a peak has a lower bound, which is not convex."""
    ranges: list[Range | None] = [asked for _, asked in problem.bounded]
    expected = as_range(problem.B)
    if expected is not None and problem.inflexion is None and not peak_in_the_middle(problem):
        # a rise is faster than 1 somewhere anyhow
        ranges += [expected] if problem.boundary is not None or expected.low > 1.0 else []
    return any(one is not None and one.low > 0.0 for one in ranges)
