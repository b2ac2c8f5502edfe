"""Making balancing cam mechanisms of types I, II and III."""

from __future__ import annotations

from optlaws.laws import MotionLaw
from optlaws.mechanisms.dwell.mechanism import DwellMechanism


def dwell_mechanism(
    kind: str,
    *,
    law: MotionLaw,
    dwell: float,
    rise: float,
    swing: float,
    radius_ratio: float,
    inertia_ratio: float,
    clutch_angle: float = 0.0,
    law_1: MotionLaw | None = None,
    law_2: MotionLaw | None = None,
    return_angle: float | None = None,
    return_law: MotionLaw | None = None,
    lower_dwell: float | None = None,
    standstill: float = 0.0,
    reverse_share: float = 0.5,
) -> DwellMechanism:
    """A balancing cam mechanism with an inertial loader, for an executive rocker that dwells.

    While the executive link dwells, the loader keeps the kinetic energy. In type I its rocker runs on with it at
    uniform speed. In types II and III a clutch lets the loader go: the rocker of type II runs out, comes back by the
    reverse motion and runs up again, that of type III runs out, may stand still and runs up again.

    Angles are in radians (`optlaws.deg` turns degrees into radians), ways in strokes S of the executive link.

    Parameters
    ----------
    kind
        "I", "II" or "III".
    law
        Executive law of the rise, from rest to rest; its loader is that of `optlaws.loader`.
    dwell
        Angle of the upper dwell.
    rise
        Angle of the rise.
    clutch_angle
        Angle in which the clutch acts at either end of the dwell, at uniform speed; not used by type I.
    swing
        Swing of the executive rocker; the rocker of the loader is as long.
    radius_ratio
        Least radius of either cam over S.
    inertia_ratio
        Moment of inertia of the loader's rocker alone over that of everything the executive rocker moves.
    law_1
        Law of run-out and run-up of type II; the executive law unless given.
    law_2
        Law of the reverse motion of type II, of run-out and run-up of type III; the executive law unless given.
    return_angle
        Angle of the return; that of the rise unless given.
    return_law
        Executive law of the return; that of the rise unless given.
    lower_dwell
        Angle of the lower dwell, 0 for none; that of the upper dwell unless given.
    standstill
        Angle in which the rocker of type III stands still in the upper dwell; in the lower one it stands still for as
        much longer as that dwell is longer.
    reverse_share
        Share of the reverse motion in the angle of type II between the clutch angles.

    Raises
    ------
    InputError
        If a number is out of range, a law is not from rest to rest, the angles leave no room for the motions, or the
        rise, the return and the dwells do not fit each other.

    Examples
    --------
    >>> from optlaws import catalogue, deg
    >>> data = dict(law=catalogue["K"].law, dwell=deg(90), rise=deg(90), clutch_angle=deg(15), swing=deg(20))
    >>> for kind in ("I", "II", "III"):
    ...     print(dwell_mechanism(kind, radius_ratio=1.0026761, inertia_ratio=0.1, **data))
    DwellMechanism(I, a=1.78435, b=0, S1=1.5708, S2=0)
    DwellMechanism(II, a=1, b=1.9827, S1=0.333333, S2=0.856932)
    DwellMechanism(III, a=1.59434, b=0.15, S1=0, S2=0.666667)
    """
    return DwellMechanism(
        kind=kind,
        law=law,
        dwell=dwell,
        rise=rise,
        clutch_angle=clutch_angle,
        swing=swing,
        radius_ratio=radius_ratio,
        inertia_ratio=inertia_ratio,
        law_1=law if law_1 is None else law_1,
        law_2=law if law_2 is None else law_2,
        return_angle=rise if return_angle is None else return_angle,
        return_law=law if return_law is None else return_law,
        lower_dwell=dwell if lower_dwell is None else lower_dwell,
        standstill=standstill,
        reverse_share=reverse_share,
    )
