"""Programs of very many cones: those that bind are found by exchange."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.synthesis.families.active_set import ActiveSet
from optlaws.synthesis.families.cone import ConeFamily
from optlaws.synthesis.families.family import Program
from optlaws.tolerances import EXCESS

#: fewer families of cones than this are solved together
_MANY = 50
#: into how many runs of neighbours they are divided: in a round the one of each that is violated most joins
_RUNS = 32


@dataclass(frozen=True, eq=False)
class FewFamilies:
    """Some of the families of a program, by their numbers in ascending order."""

    whole: Program
    chosen: NDArray[np.intp]

    @kept_property
    def program(self) -> Program:
        """The program with these families alone; its least objective is at most that of the whole."""
        return replace(self.whole, families=tuple(self.whole.families[i] for i in self.chosen))

    def inward(self, state: ActiveSet | None) -> ActiveSet | None:
        """An active set of the whole program among these families; None where it has contacts in others."""
        if state is None or not np.isin(state.family, self.chosen).all():
            return None
        return replace(state, family=np.searchsorted(self.chosen, state.family).astype(np.intp))

    def outward(self, state: ActiveSet) -> ActiveSet:
        """An active set in the whole program."""
        return replace(state, family=self.chosen[state.family])

    def joined_beyond(self, x: Array) -> FewFamilies | None:
        """These families and the most violated ones of each run, with their neighbours; None where none is violated."""
        cones, families = _cones(self.whole)
        excess = np.array([_excess(family, x) for family in families])
        excess[np.isin(cones, self.chosen)] = 0.0
        worst = _greatest_of_runs(excess)
        worst = worst[excess[worst] > 0.0]
        if not len(worst):
            return None
        around = np.clip(np.concatenate([worst - 1, worst, worst + 1]), 0, len(cones) - 1)
        return replace(self, chosen=np.union1d(self.chosen, cones[around]))


def binding_few(program: Program) -> FewFamilies | None:
    """The families from which the exchange begins; None where there are not many.

    Of the cones they are those of each run that bind the law of no coordinates most.
    """
    cones, families = _cones(program)
    if len(cones) < _MANY:
        return None
    sizes = np.array([float(family.value(np.zeros(program.size), np.zeros(1))[0]) for family in families])
    others = np.setdiff1d(np.arange(len(program.families)), cones)
    return FewFamilies(program, np.union1d(others, cones[_greatest_of_runs(sizes)]))


def _cones(program: Program) -> tuple[NDArray[np.intp], list[ConeFamily]]:
    numbered = [(i, family) for i, family in enumerate(program.families) if isinstance(family, ConeFamily)]
    return np.array([i for i, _ in numbered], dtype=np.intp), [family for _, family in numbered]


def _greatest_of_runs(sizes: Array) -> NDArray[np.intp]:
    runs = np.array_split(np.arange(len(sizes)), _RUNS)
    return np.array([run[np.argmax(sizes[run])] for run in runs], dtype=np.intp)


def _excess(family: ConeFamily, x: Array) -> float:
    """By how much a cone is violated beyond rounding; 0 where it is not."""
    right = family.right_side(x)
    least = right + EXCESS * max(1.0, abs(right))
    if np.abs(family.series @ np.append(x, 1.0)).sum() <= least:
        return 0.0
    return max(float(family.extremes(x)[2].max()) + right - least, 0.0)
