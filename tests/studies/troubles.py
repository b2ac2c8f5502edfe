"""Constants that err, hang or kill their process at one point; importing this registers them."""

import os
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass

from optlaws import FUNCTIONALS, MotionLaw
from optlaws.synthesis.functionals import Peak

TROUBLED_B = 1.7


@dataclass(frozen=True, repr=False)
class Troublesome(Peak):
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


def _err() -> None:
    raise ZeroDivisionError("a mistake in a constant")


for name, trouble in {"dies": _die, "hangs": _hang, "errs": _err}.items():
    FUNCTIONALS[name] = Troublesome(name, 4.0, convex=True, nu=2, trouble=trouble)
