"""Motions whose acceleration is a cubic polynomial of s in every element, by its values at the Gauss places.

The squared velocity is its integral, from the nearer end of the stroke, where it is 0. So the velocities at the places
say what the accelerations are, and the other way round.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from optlaws.kept import kept_property
from optlaws.numbers import Array
from optlaws.numerics.chebyshev import gauss

#: places of an element, and of an integral over a part of it
PLACES, _FINE = 4, 6
_X, _ = gauss(PLACES)
#: coefficients of the polynomials that are 1 at one place and 0 at the others
_SHAPES = np.linalg.inv(np.vander(_X, increasing=True))


@dataclass(frozen=True, eq=False)
class Elements:
    """Elements of s from 0 to 1, with motions over them.

    Attributes
    ----------
    edges
        The ends of the elements.
    """

    edges: Array

    @kept_property
    def lengths(self) -> Array:
        return np.asarray(np.diff(self.edges))

    @kept_property
    def s(self) -> Array:
        """The Gauss places of all elements, ascending."""
        return np.asarray((self.edges[:-1, None] + 0.5 * self.lengths[:, None] * (_X + 1.0)).ravel())

    @kept_property
    def turn(self) -> int:
        """The number of elements that are integrated from the first end; the others are from the last."""
        return int(np.clip(np.searchsorted(self.edges, 0.5), 1, max(len(self.edges) - 2, 1)))

    def squares(self, c: Array) -> tuple[Array, Array]:
        """The squared velocities at all places, and the accelerations, which both halves of the move have alike.

        Parameters
        ----------
        c
            The accelerations at all places.
        """
        c = c.reshape(-1, PLACES).copy()
        total = np.einsum("ij,ij->i", self._whole, c)
        reached, braked = float(np.sum(total[: self.turn])), -float(np.sum(total[self.turn :]))
        if braked > 0.0 < reached:
            c[self.turn :] *= reached / braked
        first = self._first(np.einsum("ij,ij->i", self._whole, c))
        w = first[:, None] + np.einsum("eij,ej->ei", self._to_places, c)
        return w.ravel(), c.ravel()

    def accelerations(self, w: Array) -> tuple[Array, Array]:
        """The accelerations at all places of squared velocities there, and squared velocities at the ends of elements.

        The end of an element is the one from which it is integrated.
        """
        w = w.reshape(-1, PLACES)
        c, known = np.zeros_like(w), np.zeros(len(w))
        for places in (range(self.turn), range(len(w) - 1, self.turn - 1, -1)):
            reached = 0.0
            for i in places:
                known[i] = reached
                c[i] = np.linalg.solve(self._to_places[i], w[i] - reached)
                reached += float(self._whole[i] @ c[i]) * (1.0 if i < self.turn else -1.0)
        return c, known

    def at(self, piece: NDArray[np.intp], s: Array, motion: tuple[Array, Array]) -> tuple[Array, Array]:
        """The squared velocities and the accelerations at places of pieces, each of which has a row of places.

        Parameters
        ----------
        piece, s
            The elements, and the places in them.
        motion
            What `accelerations` says.
        """
        c, known = motion
        begin = np.where(piece < self.turn, self.edges[piece], self.edges[piece + 1])
        w = known[piece, None] + np.einsum("ikj,ij->ik", self._integrals(piece[:, None], begin[:, None], s), c[piece])
        return np.asarray(w), np.asarray(np.einsum("ikj,ij->ik", self._shapes(piece[:, None], s), c[piece]))

    def _first(self, total: Array) -> Array:
        """The squared velocities at the ends from which elements are integrated."""
        rise, left = np.cumsum(total[: self.turn]), -np.cumsum(total[self.turn :][::-1])
        return np.concatenate([[0.0], rise[:-1], left[:-1][::-1], [0.0]])

    def _shapes(self, piece: NDArray[np.intp], s: Array) -> Array:
        """The polynomials that are 1 at one place of an element, at s."""
        x = 2.0 * (s - self.edges[piece]) / self.lengths[piece] - 1.0
        return np.asarray(np.stack([x**i for i in range(PLACES)], axis=-1) @ _SHAPES)

    def _integrals(self, piece: NDArray[np.intp], begin: Array, s: Array) -> Array:
        """Twice the integrals over the position of those polynomials, from one s to another."""
        x, share = gauss(_FINE)
        half = 0.5 * (s - begin)
        inner = begin[..., None] + half[..., None] * (x + 1.0)
        rate = np.pi * np.sin(np.pi * inner) * half[..., None] * share
        return np.asarray(np.einsum("...k,...kj->...j", rate, self._shapes(piece[..., None], inner)))

    @kept_property
    def _to_places(self) -> Array:
        piece = np.arange(len(self.lengths))[:, None]
        begin = np.where(piece < self.turn, self.edges[piece], self.edges[piece + 1])
        s = self.s.reshape(-1, PLACES)
        return self._integrals(np.broadcast_to(piece, s.shape), np.broadcast_to(begin, s.shape), s)

    @kept_property
    def _whole(self) -> Array:
        piece = np.arange(len(self.lengths))
        return self._integrals(piece, self.edges[:-1], self.edges[1:])
