"""The kinds of interlocks by their names, read and checked together for the axes of a machine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from optlaws.cycles.interlocks.after import After
from optlaws.cycles.interlocks.clearance import Clearance
from optlaws.cycles.interlocks.forbidden_region import Forbidden
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.cycles.interlocks.synchronous import Synchronous
from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.suggest import unknown_key

KINDS: dict[str, type[Interlock]] = {kind.kind: kind for kind in (After, Clearance, Forbidden, Synchronous)}


def read_interlock(data: Any) -> Interlock:
    """An interlock from the plain data that its `to_dict` gives.

    >>> read_interlock({"kind": "after", "axis": "table", "position": "5 deg", "of": "die", "above": "31 mm"}).words
    'table passes 5 deg after die is above 31 mm'
    """
    kind = data.get("kind") if isinstance(data, Mapping) else None
    if not isinstance(kind, str) or kind not in KINDS:
        raise InputError(f"interlock: {unknown_key(kind, KINDS, 'kind')}, in {shortened(data)}")
    return KINDS[kind].from_dict(data)


def checked(given: Any, cycles: Mapping[str, Any]) -> tuple[Interlock, ...]:
    """Interlocks of a machine, as values or plain data, each fit for its axes."""
    if not isinstance(given, list | tuple):
        raise InputError(f"interlocks are a list such as [After('table', '5 deg', of='die', above='31 mm')], got "
                         f"{shortened(given)}")  # fmt: skip
    interlocks = tuple(each if isinstance(each, Interlock) else read_interlock(each) for each in given)
    for interlock in interlocks:
        interlock.check(cycles)
    return interlocks
