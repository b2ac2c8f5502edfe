"""Interlocks between axes, and how moves overlap, as problem files have them."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from optlaws.files.problem_file import Text


class InterlockEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A condition on two axes; which entries it has beside the axis depends on its kind."""

    kind: Literal["after", "clearance", "forbidden", "synchronous"]
    axis: Text
    name: Text | None = None
    position: str | None = None
    of: str | None = None
    above: str | None = None
    below: str | None = None
    way: str | None = None
    over: str | None = None
    least: str | list[list[str]] | None = None
    most: str | list[list[str]] | None = None
    units: list[str] | None = None
    across: str | None = None
    corners: list[list[str]] | None = None
    to: str | None = None
    during: list[str] | None = None
    within: str | None = None
    ratio: float | None = None


class OverlapEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """How moves are to overlap: the goal, and of an acceleration the axes whose moves may take longer."""

    goal: Literal["period", "acceleration"]
    of: Annotated[list[Text], msgspec.Meta(max_length=8)] = []
