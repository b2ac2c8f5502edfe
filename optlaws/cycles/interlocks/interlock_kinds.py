"""Interlocks of every kind, read and checked together for the axes of a machine."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from optlaws.cycles.interlocks import after, clearance, forbidden_region, synchronous  # noqa: F401 - by which kinds are known
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.entries.declared import ValueOf
from optlaws.entries.value_types import Listed

INTERLOCKS = Listed(ValueOf(Interlock), each="interlock")


def checked(given: Any, cycles: Mapping[str, Any]) -> tuple[Interlock, ...]:
    """Interlocks of a machine, as values or plain data, each fit for its axes."""
    interlocks: tuple[Interlock, ...] = INTERLOCKS.read(given, "interlocks")
    for interlock in interlocks:
        interlock.check(cycles)
    return interlocks
