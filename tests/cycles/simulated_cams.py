"""Cams of which all is known, sampled, rounded, noisy and dusty as tables of old cams are: a cam for each seed."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import accumulate, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, make_interp_spline

from optlaws import catalogue

Array = NDArray[np.float64]
Motion = Callable[[Array], Array]

TURN = 360.0
#: laws from rest to rest of finite acceleration
LAWS = [name for name in catalogue if np.isfinite(catalogue[name].law.constants.C.value)]


@dataclass(frozen=True)
class Piece:
    """A part of a turn: how long it is, how far it goes, its law from 0 to 1, and the greatest acceleration of this."""

    length: float
    stroke: float
    law: Motion
    peak: float


@dataclass(frozen=True)
class SimulatedCam:
    """Rows of a table, and what these are samples of."""

    places: Array
    heights: Array
    acceleration: float  #: the greatest one, by degree²; inf where the velocity jumps
    specks: tuple[int, ...]
    noise: float
    digit: float
    kind: str
    exact: Motion


def standard(rng: np.random.Generator) -> tuple[Motion, float]:
    """A law of the catalogue that rests at its ends."""
    while True:
        law = catalogue[str(rng.choice(LAWS))].law
        if max(abs(float(law.b(0.0))), abs(float(law.b(1.0)))) < 1e-9:
            return law, float(law.constants.C.value)


def polynomial(rng: np.random.Generator) -> tuple[Motion, float]:
    """A polynomial from rest to rest, bent at random."""
    order = int(rng.integers(2, 5))
    rest = np.polynomial.Polynomial([0.0, 1.0]) ** order * np.polynomial.Polynomial([1.0, -1.0]) ** order
    slope = rest * np.polynomial.Polynomial(1.0 + 0.4 * rng.uniform(-1.0, 1.0, 4))
    whole = slope.integ()
    law = whole / whole(1.0)
    return law, greatest(law.deriv(2), 0.0, 1.0)


def spline(rng: np.random.Generator) -> tuple[Motion, float]:
    """A spline from rest to rest through points near a smooth law."""
    k = np.linspace(0.0, 1.0, int(rng.integers(4, 9)))
    a = k**3 * (10.0 - 15.0 * k + 6.0 * k * k)
    a[1:-1] += 0.04 * rng.uniform(-1.0, 1.0, len(k) - 2)
    degree = int(rng.choice([3, 5]))
    rest: Any = [(nu, 0.0) for nu in range(1, 1 + degree // 2)]
    law = make_interp_spline(k, a, degree, bc_type=(rest, rest))
    return law, greatest(law.derivative(2), 0.0, 1.0)


def greatest(function: Motion, start: float, stop: float) -> float:
    """The greatest magnitude in an interval."""
    return float(np.abs(function(np.linspace(start, stop, 20001))).max())


def move(rng: np.random.Generator, length: float, stroke: float) -> Piece:
    """A move of any law."""
    law, peak = rng.choice([standard, standard, polynomial, spline])(rng)  # type: ignore[arg-type]
    return Piece(length, stroke, law, peak)


def dwell(length: float) -> Piece:
    """A rest."""
    return Piece(length, 0.0, np.zeros_like, 0.0)


def chained(pieces: list[Piece]) -> tuple[Motion, float]:
    """Pieces one after another in a turn, and their greatest acceleration."""
    ends = np.array([0.0, *accumulate(piece.length for piece in pieces)])
    levels = np.array([0.0, *accumulate(piece.stroke for piece in pieces)])

    def motion(x: Array) -> Array:
        turns = np.floor(x / TURN)
        at = x - TURN * turns
        y = np.zeros_like(at)
        for i, (low, high) in enumerate(pairwise(ends)):
            inside = (at >= low) & (at <= high)
            y[inside] = levels[i] + pieces[i].stroke * pieces[i].law((at[inside] - low) / (high - low))
        return np.asarray(y + turns * levels[-1])

    return motion, max(abs(piece.stroke) * piece.peak / piece.length**2 for piece in pieces)


def lengths(rng: np.random.Generator, parts: int) -> list[float]:
    """Lengths that fill a turn, none of them short; half of them round."""
    shares = rng.uniform(1.0, 3.0, parts)
    size = TURN * shares / shares.sum()
    if rng.random() < 0.5:
        size = np.maximum(5.0 * np.round(size / 5.0), 10.0)
        size[-1] = TURN - size[:-1].sum()
    return list(map(float, size))


def with_dwells(rng: np.random.Generator, stroke: float) -> tuple[Motion, float]:
    """Rise, dwell, return, dwell; some with a second rise."""
    if rng.random() < 0.5:
        a, b, c, d = lengths(rng, 4)
        return chained([move(rng, a, stroke), dwell(b), move(rng, c, -stroke), dwell(d)])
    a, b, c, d, e, f = lengths(rng, 6)
    half = stroke * rng.uniform(0.3, 0.7)
    rest = [move(rng, a, half), dwell(b), move(rng, c, stroke - half), dwell(d), move(rng, e, -stroke), dwell(f)]
    return chained(rest)


def with_a_crest(rng: np.random.Generator, stroke: float) -> tuple[Motion, float]:
    """A lobe without a dwell at its crest, as of a valve."""
    a, b, c = lengths(rng, 3)
    return chained([move(rng, a, stroke), move(rng, b, -stroke), dwell(c)])


def without_dwells(rng: np.random.Generator, stroke: float) -> tuple[Motion, float]:
    """Moves without any rest: laws from turn to turn, some harmonics, or a periodic spline."""
    which = rng.integers(3)
    if which == 0:
        a, b = lengths(rng, 2)
        return chained([move(rng, a, stroke), move(rng, b, -stroke)])
    if which == 1:
        count = int(rng.integers(1, 5))
        sizes = stroke / 2 / np.arange(1, count + 1) ** 2 * rng.uniform(0.3, 1.0, count)
        phases, w = rng.uniform(0.0, 2.0 * np.pi, count), 2.0 * np.pi / TURN * np.arange(1, count + 1)
        return (
            lambda x: np.cos(x[:, None] * w + phases) @ sizes,
            greatest(lambda x: np.cos(x[:, None] * w + phases) @ (sizes * w**2), 0.0, TURN),
        )
    return periodic_spline(rng, stroke, 0.0)


def periodic_spline(rng: np.random.Generator, stroke: float, advance: float) -> tuple[Motion, float]:
    """A periodic spline through a few points, that may advance."""
    count = int(rng.integers(5, 10))
    x = np.linspace(0.0, TURN, count + 1)
    y = 0.5 * stroke * np.sin(2.0 * np.pi * np.arange(count + 1) / count) + 0.1 * stroke * rng.uniform(-1, 1, count + 1)
    y[-1] = y[0]
    curve: BSpline = make_interp_spline(x, y, int(rng.choice([3, 5])), bc_type="periodic")
    return (lambda at: curve(np.mod(at, TURN)) + advance * at / TURN, greatest(curve.derivative(2), 0.0, TURN))


def endless(rng: np.random.Generator, stroke: float) -> tuple[Motion, float]:
    """Motions that advance in a turn: indexing, and about a constant velocity."""
    which = rng.integers(3)
    if which == 0:
        a, b = lengths(rng, 2)
        return chained([move(rng, a, stroke), dwell(b)])
    if which == 1:
        return periodic_spline(rng, 0.2 * stroke, stroke * rng.uniform(1.0, 3.0))
    a, b, c, d = lengths(rng, 4)
    gap, peak = chained([move(rng, a, stroke / 5), dwell(b), move(rng, c, -stroke / 5), dwell(d)])
    return lambda x: gap(x) + 2.0 * stroke * x / TURN, peak


def with_corners(rng: np.random.Generator, stroke: float) -> tuple[Motion, float]:
    """A move at constant velocity between rests: its velocity jumps."""
    a, b, c, d = lengths(rng, 4)
    return chained([Piece(a, stroke, lambda k: k, np.inf), dwell(b), move(rng, c, -stroke), dwell(d)])


KINDS = {
    "dwells": (with_dwells, 0.35),
    "crest": (with_a_crest, 0.2),
    "no dwell": (without_dwells, 0.2),
    "endless": (endless, 0.2),
    "corners": (with_corners, 0.05),
}


def simulated_cam(seed: int, rows: int | None = None) -> SimulatedCam:
    """The cam of a seed, from 36 to 3,600 rows, or as many as are given."""
    rng = np.random.default_rng(seed)
    kind = str(rng.choice(list(KINDS), p=[share for _, share in KINDS.values()]))
    stroke = float(np.round(10.0 ** rng.uniform(0.5, 2.0), 1))
    motion, acceleration = KINDS[kind][0](rng, stroke)
    begin = float(rng.choice([0.0, rng.uniform(0.0, TURN)]))
    count = round(10.0 ** rng.uniform(np.log10(36.0), np.log10(3600.0)))
    count = count if rows is None else rows
    places = np.linspace(0.0, TURN, count + 1)
    exact = partial(_begun, motion, begin)
    heights = exact(places)
    noise = stroke * float(rng.choice([0.0, 10.0 ** rng.uniform(-5.0, -3.0)]))
    heights = heights + rng.normal(0.0, 1.0, count + 1) * noise
    decimals = int(rng.choice([2, 3, 4, 5, 12]))
    digit = 10.0**-decimals
    specks = rng.choice(count - 1, int(rng.integers(0, 1 + min(8, count // 18))), replace=False) + 1
    size = (noise + 2.0 * digit) * rng.uniform(10.0, 100.0, len(specks))
    heights[specks] += size * rng.choice([1.0, 1.0, 1.0, -1.0], len(specks))
    return SimulatedCam(
        places, np.round(heights, decimals), acceleration, tuple(sorted(map(int, specks))), noise, digit, kind, exact
    )


def _begun(motion: Motion, begin: float, x: Array) -> Array:
    start = np.array([begin])
    return np.asarray(motion(x + begin) - motion(start))
