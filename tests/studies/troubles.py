"""Constants that err, hang or kill their process at one point; importing this registers them."""

import os
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass

from optlaws import FUNCTIONALS, MotionLaw
from tests.internals.synthesis import PeakConstant

TROUBLED_B = 1.7


@dataclass(frozen=True, repr=False)
class Troublesome(PeakConstant):
    """C, but that a law with B = 1.7 is in for it."""

    trouble: Callable[[], object] = int

    def value(self, law: MotionLaw) -> float:
        if abs(law.b(0.5) - TROUBLED_B) < 1e-9:
            self.trouble()
        return super().value(law)


def _die() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def _hang() -> None:
    while True:
        time.sleep(0.01)


def _hang_with_a_child() -> None:
    if os.fork() == 0:
        time.sleep(30.0)
        os._exit(0)
    _hang()


def _die_with_a_child() -> None:
    if os.fork() == 0:
        time.sleep(30.0)
        os._exit(0)
    _die()


def _err() -> None:
    raise ZeroDivisionError("a mistake in a constant")


for name, trouble in {
    "dies": _die,
    "hangs": _hang,
    "errs": _err,
    "hangs_forked": _hang_with_a_child,
    "dies_forked": _die_with_a_child,
}.items():
    FUNCTIONALS[name] = Troublesome(name, 4.0, convex=True, nu=2, trouble=trouble)
