"""The vibration that a mode is left with, as a constant of a law, over a box of frequencies and damping ratios.

For each root w the complex amplitude is kappa times the integral of exp(w (1 - k)) b(k), affine in the law; kappa, the
mode's share in the output, stays as it is. That is so when the machine runs at another speed, and it is what is meant
by a frequency or a damping that is not known well. The integral is analytic in w: over a box of frequencies and damping
ratios its magnitude is greatest on the edges, each of which is a second-order cone for each of its places.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import asin, ceil, nan

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property
from optlaws.laws import MotionLaw, Peak
from optlaws.mechanisms.machine.modes import mode, participation
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.mechanisms.machine.texts import check_rest, machine_of, text_of, title_of
from optlaws.mechanisms.residual import (
    cached_columns,
    domain_of,
    greatest_modulus,
    terms_of_exponential,
    velocity_transforms,
    widened,
)
from optlaws.mechanisms.transforms import velocity_transform_of
from optlaws.numbers import Array, Complex, not_negative, numbers, power_of_two
from optlaws.numerics import chebyshev
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.problem.constants import MAKERS, Functional
from optlaws.synthesis.spaces.space import LawSpace
from optlaws.tolerances import NEGLIGIBLE_TERM

_SPARE = 40
_WIDEST = 1000.0
_MOST_DAMPING = 0.95
_ACCELERATION = 6.0  # of a smooth law


@dataclass(frozen=True)
class BoxEdge:
    """Roots i nu exp(i angle) with sin(angle) the damping ratio, between two of one frequency or of one angle."""

    first: tuple[float, float]
    last: tuple[float, float]

    @property
    def single(self) -> bool:
        """Whether the edge is a single root."""
        return self.first == self.last

    def roots(self, u: Array) -> Complex:
        """The roots at places from -1 to 1."""
        share = 0.5 * (1.0 + u)
        frequency, angle = (a + share * (b - a) for a, b in zip(self.first, self.last, strict=True))
        return np.asarray(1j * frequency * np.exp(1j * angle))

    @property
    def nodes(self) -> Array:
        """Chebyshev nodes, enough for functions of exponential type 1 in the root."""
        if self.single:
            return np.ones(1)
        ends = self.roots(np.array([-1.0, 1.0]))
        length = float(abs(ends[1] - ends[0]))
        straight = self.first[1] == self.last[1]
        return chebyshev.nodes(terms_of_exponential(0.5 * length) if straight else ceil(0.75 * length) + _SPARE)


@dataclass(frozen=True, repr=False)
class ModeResidual(Functional):
    """Greatest amplitude of a mode in an output after the motion, over a box; constructed by `Machine.residual`.

    The mode's frequency may be off by the share `spread`, either way; `dampings` are the least and the greatest ratio,
    or None for the mode's own.
    """

    machine: StateSpace = field(compare=False)
    output: str = field(compare=False)
    mode: int
    spread: float
    dampings: tuple[float, float] | None

    normalised = True

    @kept_property
    def scale(self) -> float:
        """The size of the mode's vibration after a law whose acceleration jumps; a power of 2."""
        least = min(min(edge.first[0], edge.last[0]) for edge in self.edges)
        return power_of_two(self.share * min(1.0, _ACCELERATION / least**2))

    @property
    def title(self) -> str:
        """A few words for it; the name has the whole machine in it."""
        words = [f"within {100.0 * self.spread:g} %"] if self.spread else []
        words += [] if self.dampings is None else ["damping {:g} to {:g}".format(*self.dampings)]
        return title_of(self.machine, f"residual of mode {self.mode} in", self.output, *words)

    def value(self, law: MotionLaw) -> float:
        """The greatest over the box."""
        return self.worst(law).value

    def worst(self, law: MotionLaw) -> Peak:
        """The greatest over the box; its `k` is the frequency at which it is, in radians in the rise's duration."""
        transform = velocity_transform_of(law)

        def greatest(edge: BoxEdge) -> Peak:
            value, place = greatest_modulus(lambda u: self.share * transform(edge.roots(u)), edge.nodes)
            return Peak(value, abs(complex(edge.roots(np.array([place]))[0])))

        return max(map(greatest, self.edges), key=lambda peak: peak.value)

    @kept_property
    def share(self) -> float:
        """The mode's amplitude in the output over the magnitude of the integral of exp(root (1 - k)) b(k)."""
        return abs(participation(self.machine, mode(self.machine, self.mode), self.output))

    @kept_property
    def edges(self) -> tuple[BoxEdge, ...]:
        """The edges of the box; one where it is thin."""
        vibration = mode(self.machine, self.mode)
        low, high = ((1.0 + sign * self.spread) * vibration.frequency for sign in (-1.0, 1.0))
        least, most = (asin(damping) for damping in self.dampings or (vibration.damping, vibration.damping))
        corners = [(low, least), (high, least), (high, most), (low, most)]
        sides = [BoxEdge(*sorted((a, b))) for a, b in zip(corners, [*corners[1:], corners[0]], strict=True)]
        counted = list(dict.fromkeys(side for side in sides if not side.single)) or [BoxEdge(corners[0], corners[0])]
        return tuple(counted)

    def families(self, space: LawSpace, slack: Array, bound: float) -> tuple[ConeFamily, ...]:
        """A cone for each place of each edge, in units of the bound, or of the base law's residual."""
        check_rest(self.name, space)
        families = []
        for i, (name, edge) in enumerate(zip(self.part_names, self.edges, strict=True)):
            unit = self.unit(space, i, bound, sought=bool(slack.any()))
            series = widened(self._columns(space, i), len(slack)) / unit
            domain = domain_of(edge.nodes)
            families.append(ConeFamily(name, slack / unit, bound / unit, domain=domain, series=series))
        return tuple(families)

    def unit(self, space: LawSpace, edge: int, bound: float, *, sought: bool) -> float:
        """The unit of the rows of an edge: the bound, or the base law's residual if there is no bound."""
        return bound or (float(np.abs(self._columns(space, edge)[:, -1]).max()) if sought else 0.0) or 1.0

    @property
    def part_names(self) -> tuple[str, ...]:
        """Names of the edges in certificates."""
        return (self.name, *(f"{self.name}, edge {i + 1}" for i in range(1, len(self.edges))))

    def where(self, k: float, part: int = 0) -> str:
        """The frequency of a place on an edge."""
        return f"frequency = {abs(self.edges[part].roots(np.array([2.0 * k - 1.0]))[0]):.5g}"

    def _columns(self, space: LawSpace, edge: int) -> Complex:
        """Chebyshev series of the complex amplitude: free functions, then the base law."""
        return cached_columns(space, ("mode", self.name, edge), lambda: self._computed(space, self.edges[edge]))

    def _computed(self, space: LawSpace, edge: BoxEdge) -> Complex:
        roots = edge.roots(edge.nodes)
        transforms = velocity_transforms(space, roots, float(np.abs(roots).max()))
        series = chebyshev.from_values(self.share * transforms)
        counted = np.flatnonzero(np.abs(series).max(axis=1) > NEGLIGIBLE_TERM * np.abs(series).max())
        # an output may not see the mode at all
        return np.ascontiguousarray(series[: counted[-1] + 1 if len(counted) else 1])


def mode_residual(
    *,
    of: str | StateSpace,
    mode: float = 1,
    spread: float = 0.0,
    damping: tuple[float, float] | float | None = None,
    output: str | None = None,
) -> ModeResidual:
    """The greatest amplitude that a mode is left with in an output, over a box, as `Machine.residual` has it.

    `of` is the machine, or its text with the output.

    Examples
    --------
    >>> from optlaws import Machine, smoothstep
    >>> machine = Machine([[0, 1], [-400, -2]], [[0], [400]], [[-400, -2]], [[400]], outputs=["acceleration"])
    >>> mode_residual(of=machine).value(smoothstep(4))
    1.650151
    """
    machine = machine_of(of)
    name = machine.outputs[machine.place(output)]
    mode_number = _mode_number(machine, mode, name)
    share = not_negative(spread, "spread")
    pair = damping if isinstance(damping, list | tuple) else (damping, damping)
    dampings = None if damping is None else numbers(pair, "damping")
    if dampings is not None and (len(dampings) != 2 or not 0.0 <= dampings[0] <= dampings[1] <= _MOST_DAMPING):
        raise InputError(
            f"damping must be a ratio, or the least and the greatest of them, from 0 to {_MOST_DAMPING:g}, "
            f"got {shortened(damping)}"
        )
    if share >= 1.0:
        raise InputError(f"spread is a share of the frequency, below 1, such as 0.1, got {share:g}")
    words = [f"of={text_of(machine, name)!s}", f"mode={mode_number}"]
    words += [f"spread={share!r}"] if share else []
    words += [f"damping=({dampings[0]!r}, {dampings[1]!r})"] if dampings else []
    text = f"mode_residual({', '.join(words)})"
    pairs = None if dampings is None else (dampings[0], dampings[1])
    constant = ModeResidual(
        text, nan, convex=True, machine=machine, output=name, mode=mode_number, spread=share, dampings=pairs
    )
    constant.share  # noqa: B018 - a defective mode is refused at once
    return constant


def _mode_number(machine: StateSpace, number: float, output: str) -> int:
    vibration = mode(machine, number)
    if vibration.frequency > _WIDEST * 10.0 or vibration.damping > _MOST_DAMPING:
        raise InputError(f"mode {vibration.number} hardly vibrates: use the peak of {output!r} in the dwell instead")
    return vibration.number


MAKERS.setdefault("mode_residual", mode_residual)
