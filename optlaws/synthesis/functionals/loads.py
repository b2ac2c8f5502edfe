"""What drives a machine along a law: the torque against inertia, friction and load, as a formula of the motion."""

from __future__ import annotations

from optlaws.formulas.reading import read
from optlaws.formulas.slopes import added, derivative, multiplied
from optlaws.formulas.tree import Exponentiation, Name, Number


def drive_torque(*, inertia: str = "1", friction: str = "0", load: str = "0") -> str:
    """The torque I(a) c + I'(a) b²/2 + friction b + load that drives a law, as the text of a formula.

    Parameters
    ----------
    inertia
        Moment of inertia over the displacement a, in units in which the rest is said too: "1", "1 + 0.3*a^2",
        "spline(a, 0:1, 0.3:1.1, 0.7:1.4, 1:1.3)".
    friction
        Viscous friction, of a and k.
    load
        External force over k or over a: "4*a", "table(k, 0:0, 0.4:0, 0.5:6, 0.6:0, 1:0)".

    Raises
    ------
    InputError
        If a part is no formula of a and k, or the inertia has kinks.

    Examples
    --------
    >>> drive_torque(friction="0.5", load="4*a")
    'c + 0.5*b + 4*a'
    >>> drive_torque(inertia="1 + 0.3*a^2")
    '(1 + 0.3*a^2)*c + 0.5*0.3*2*a*b^2'
    >>> drive_torque(inertia="spline(a, 0:1, 0.3:1.1, 0.7:1.4, 1:1.3)")[-44:]
    'spline1(a, 0:1, 0.3:1.1, 0.7:1.4, 1:1.3)*b^2'
    """
    mass, drag, force = (read(text, ("a", "k")) for text in (inertia, friction, load))
    square = Exponentiation(Name("b"), Number(2.0))
    turning = multiplied([Number(0.5), derivative(mass, "a"), square])
    return str(added([multiplied([mass, Name("c")]), turning, multiplied([drag, Name("b")]), force]))
