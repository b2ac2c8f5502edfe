"""The rules of convexity: by what is known, and by random motions."""

from random import Random

import numpy as np
import pytest

from tests.formulas.trees import convex_text
from tests.internals.formulas import NUMPY, Curvature, Judge, evaluate, read

RULES = Judge(frozenset("bc"))


@pytest.mark.parametrize(
    ("written", "kind"),
    [
        ("k^2 + 3", "constant"),
        ("c + 0.2*b", "affine"),
        ("sin(6*k)*c - k", "affine"),
        ("c^2 + (1 + k)*b^2", "convex"),
        ("-(c - b)^2", "concave"),
        ("k*(1 - k)*c^2", "convex"),
        ("(k - 0.5)*c^2", "not known to be convex"),
        # what cancels is rounded, and with it the sign
        ("(k - 0.5 + 1e17 - 1e17)*c^2", "not known to be convex"),
        ("b*c", "not known to be convex"),
        ("a*c", "not known to be convex"),
        ("c^2 + b*c + b^2", "convex"),
        ("c^2 + 2*b*c + b^2", "convex"),
        ("c^2 + 2.001*b*c + b^2", "not known to be convex"),
        ("c^2 + k*b*c + b^2", "convex"),
        ("c^2 + 2*k*b*c + b^2", "not known to be convex"),
        ("abs(c + b)", "convex"),
        ("max(c, -2*b, 1)", "convex"),
        ("min(c, b)", "concave"),
        ("norm(c, 3*b)", "convex"),
        ("exp(c^2)", "convex"),
        ("exp(-c^2)", "not known to be convex"),
        ("sqrt(c)", "concave"),
        ("log(b + 2)", "concave"),
        ("c^3", "not known to be convex"),
        ("abs(c)^3", "convex"),
        ("(c^2 + 1)^2", "convex"),
        ("1/(2 + c^2)", "not known to be convex"),
        ("sin(c)", "not known to be convex"),
        ("2^c", "convex"),
        ("c^2/2 - b", "convex"),
        ("table(b, 0:1, 1:0, 2:0.5)", "convex"),
        ("table(b, 0:0, 1:1, 2:0.5)", "concave"),
        ("table(b, 0:0, 1:1, 2:0, 3:1)", "not known to be convex"),
        ("spline(b, 0:0, 1:1, 2:4, 3:9)", "convex"),
    ],
)
def test_what_is_known_is_said(written: str, kind: str) -> None:
    verdict = Judge(frozenset("abc")).verdict(read(written))
    assert verdict.curvature.value == kind, verdict.why
    assert str(verdict.part) in verdict.why


def random_verdicts(seed: int, count: int) -> list[tuple[str, Curvature]]:
    numbers = Random(seed)  # noqa: S311
    return [
        (written, RULES.verdict(read(written)).curvature) for written in (convex_text(numbers, 3) for _ in range(count))
    ]


def test_what_is_called_convex_bends_upward_along_every_way() -> None:
    numbers, seen = np.random.default_rng(0), 0
    for written, kind in random_verdicts(5, 600):
        if kind is Curvature.UNKNOWN:
            continue
        ends = numbers.normal(size=(2, 2, 200)) * 2.0
        with np.errstate(all="ignore"):
            first, last, middle = (
                np.broadcast_to(evaluate(read(written), {"b": at[0], "c": at[1]}, NUMPY), 200)
                for at in (ends[0], ends[1], ends.mean(axis=0))
            )
            bend = (first + last) / 2.0 - middle
            size = 1e-9 * (1.0 + np.abs(first) + np.abs(last) + np.abs(middle))
        known = np.isfinite(bend) & np.isfinite(size)
        if kind.convex:
            assert (bend >= -size)[known].all(), written
        if kind.concave:
            assert (bend <= size)[known].all(), written
        seen += kind not in {Curvature.CONSTANT, Curvature.AFFINE}
    assert seen > 100
