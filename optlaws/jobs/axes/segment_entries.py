"""Segments of a cycle as problem files have them."""

from __future__ import annotations

from typing import Any, Literal

import msgspec

from optlaws.cycles.interchange import KINDS
from optlaws.cycles.specification.segments import CycleSegment
from optlaws.errors import InputError
from optlaws.files.problem_file import Text

Kind = Literal["dwell", "constant velocity", "move", "rise", "return", "free"]


class SegmentEntries(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A segment; which entries it may have beside its duration depends on its kind."""

    kind: Kind
    duration: str | list[str] | None = None
    least: str | None = None
    name: str | None = None
    by: str | None = None
    to: str | None = None
    law: Text | None = None
    limits: dict[str, str | list[str]] | None = None
    velocity: str | None = None
    start_velocity: str | None = None
    end_velocity: str | None = None
    via: list[list[str]] | None = None


def given(entries: msgspec.Struct) -> dict[str, Any]:
    """Entries of a segment that the file gives."""
    return {name: value for name, value in msgspec.structs.asdict(entries).items() if value is not None}


def segment_of(entries: SegmentEntries, number: int) -> CycleSegment:
    """A segment of a file."""
    kind = KINDS[entries.kind]
    fields = given(entries)
    del fields["kind"]
    taken = kind.__dataclass_fields__
    for name in fields:
        if name not in taken:
            raise InputError(f"segment {number}: a {entries.kind} takes no {name}; it takes {', '.join(taken)}")
    if entries.kind == "constant velocity" and entries.velocity is None:
        raise InputError(f"segment {number}: a constant velocity needs its velocity, such as velocity = '300 mm/s'")
    segment: CycleSegment = kind(**fields)
    return segment
