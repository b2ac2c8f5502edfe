"""Laws and motions that the tests of exports share."""

from functools import cache
from typing import Any

from optlaws import Chebyshev, ConstantVelocity, Cycle, Dwell, MotionLaw, Problem, Return, Rise, synthesize
from tests.internals.motion import Motion, motion_of_law

SAID: dict[str, Any] = {"stroke": "35 mm", "master": "120 deg", "duration": "0.1 s"}
#: rows of a cam profile as a controller's project stores them: (0, 0), (40, 20), (100, 25), slopes 1 and 0 at the ends
GOLDEN = (
    "[2,0,0,0,0,1,0,0,1072693248,0,-1080956027,515396076,1059086925,-755914243],"
    "[2,1078198272,0,1077149696,0,1,0,0,1070176665,-1717986918,-1083933983,1202590845,1055091462,-418679770],"
    "[2,1079574528,0,1077477376,0,1,0,0,0,0,0,0,0,0]"
)


@cache
def optimal() -> MotionLaw:
    """The law of least C with B = 1.859 of order 4 and degree 9."""
    return synthesize(Problem(B=1.859, order=4, basis=Chebyshev(9))).law


@cache
def one_shot() -> Motion:
    """It with a stroke, over an angle and at a speed."""
    return motion_of_law(optimal(), **SAID)


@cache
def press(law: str = "modified sine") -> Cycle:
    """A rise, a dwell, a return and a dwell."""
    return Cycle(
        [Rise("35 mm", "120 deg", law=law), Dwell("90 deg"), Return(duration="100 deg", law=law), Dwell()],
        speed="200 rpm",
    )


@cache
def repeating() -> Motion:
    """The cycle as a motion."""
    return press().motion()


@cache
def turning() -> Cycle:
    """A table that goes on by 45 deg."""
    return Cycle([Rise("45 deg", "400 ms", law="cycloidal"), Dwell("1600 ms")], period="2 s", advance="45 deg")


@cache
def shearing() -> Cycle:
    """A shear that runs with its web and returns, whose end meets its start but for rounding."""
    return Cycle([ConstantVelocity("1.5 m/s", "80 ms"), Return()], period="400 ms", degree=15)
