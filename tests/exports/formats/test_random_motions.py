"""Random motions through the formats of polynomials: what is read back is what the report says."""

import numpy as np
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st

from optlaws import BoundaryConditions, Powers, law_from_z
from tests.exports.formats.test_controllers import READ, same
from tests.internals.exports import export_motion
from tests.internals.motion import Motion, motion_of_law
from tests.sampling import examples

STROKES = ("35 mm", "-20 deg", "1200 mm", "7 deg")
MASTERS = ("120 deg", "360 deg", "90 mm")


def random_motion(number: int) -> Motion:
    """A law of order 3 with a random Z, in random units."""
    rng = np.random.default_rng(number)
    z = rng.normal(size=rng.integers(1, 8)).tolist()
    law = law_from_z(BoundaryConditions.rest(3), z, Powers(len(z) - 1))
    return motion_of_law(law, stroke=str(rng.choice(STROKES)), master=str(rng.choice(MASTERS)), duration="0.2 s")


def comes_back(number: int) -> None:
    motion = random_motion(number)
    for name, read in READ.items():
        made = export_motion(motion, name)
        same(made.run, read(made.text), 1e-5 if name == "br-acp10" else 1e-10)
        assert made.report.deviation[0].value <= 1e-2 * motion.stroke
        assert made.report.ratio(2) <= 1.0 + 2e-3


@seed(2026)
@settings(max_examples=3, deadline=None)
@given(st.integers(0, 10**6))
def test_random_motions_come_back(number: int) -> None:
    comes_back(number)


@pytest.mark.long
@seed(2027)
@examples(60)
@given(st.integers(0, 10**6))
def test_many_random_motions_come_back(number: int) -> None:
    comes_back(number)
