"""Assembly of a four-bar: Grashof's rule, dead centres, and the range of its crank."""

from __future__ import annotations

from math import acos, degrees, pi

from optlaws.errors import InputError


def check_four_bar(crank: float, coupler: float, rocker: float, frame: float, ends: tuple[float, float]) -> None:
    """Refuse a range of the crank's angle that a four-bar does not reach; lengths in m, angles in rad from the frame.

    Raises
    ------
    InputError
        If the links do not close, or stretch or fold within the range: at a dead centre the crank cannot go on. The
        error names Grashof's sums and the angles that are reached.

    Examples
    --------
    >>> check_four_bar(0.1, 0.3, 0.25, 0.35, (0.0, 6.28))
    >>> check_four_bar(0.2, 0.3, 0.1, 0.35, (0.0, 1.0))
    Traceback (most recent call last):
    optlaws.errors.InputError: the crank reaches no angle from -28.955 to 28.955 deg: coupler and rocker are in line, ...
    """  # noqa: E501
    lengths = {"crank": crank, "coupler": coupler, "rocker": rocker, "frame": frame}
    longest = max(lengths, key=lambda name: lengths[name])
    others = sum(lengths.values()) - lengths[longest]
    if lengths[longest] >= others:
        raise InputError(
            f"the links do not close: the {longest} of {lengths[longest]:g} m is as long as the others together, "
            f"{others:g} m; make it shorter"
        )
    for low, high, why in _unreached(crank, coupler, rocker, frame):
        for turn in range(int(ends[0] // (2.0 * pi)) - 1, int(ends[1] // (2.0 * pi)) + 2):
            first, last = low + 2.0 * pi * turn, high + 2.0 * pi * turn
            if first <= ends[1] and last >= ends[0]:
                raise InputError(
                    f"the crank reaches no angle from {degrees(first):.6g} to {degrees(last):.6g} deg: {why} at these "
                    f"dead centres, beyond which the crank cannot go, and the range is {degrees(ends[0]):.6g} to "
                    f"{degrees(ends[1]):.6g} deg. {_grashof(lengths)}; take a range in over= between dead centres, or "
                    "other lengths"
                )


def _unreached(crank: float, coupler: float, rocker: float, frame: float) -> list[tuple[float, float, str]]:
    """Intervals of the crank's angle in which the links cannot be assembled, and the failures at their ends."""
    unreached = []
    middle, swing = crank**2 + frame**2, 2.0 * crank * frame
    # the distance of the crank's pin from the rocker's pivot is sqrt(middle - swing cos x)
    stretched = (middle - (coupler + rocker) ** 2) / swing
    folded = (middle - (coupler - rocker) ** 2) / swing
    if stretched >= -1.0:
        edge = acos(min(stretched, 1.0))
        unreached.append((edge, 2.0 * pi - edge, "coupler and rocker are in line, stretched,"))
    if folded <= 1.0:
        edge = acos(max(folded, -1.0))
        unreached.append((-edge, edge, "coupler and rocker are in line, folded,"))
    return unreached


def _grashof(lengths: dict[str, float]) -> str:
    """Grashof's rule in the numbers of a four-bar."""
    names = sorted(lengths, key=lambda name: lengths[name])
    outer, inner = lengths[names[0]] + lengths[names[3]], lengths[names[1]] + lengths[names[2]]
    sums = f"shortest and longest link make {outer:g} m, the two others {inner:g} m"
    if outer > inner:
        return f"By Grashof's rule no link turns fully: {sums}"
    turning = "crank" if names[0] in {"crank", "frame"} else names[0]
    return f"By Grashof's rule the {turning} turns fully: {sums}"
