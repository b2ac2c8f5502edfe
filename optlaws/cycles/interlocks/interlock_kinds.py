"""Interlocks of every kind, read and checked together for the axes of a machine."""

from __future__ import annotations

from optlaws.cycles.interlocks import after, clearance, forbidden_region, synchronous  # noqa: F401 - by which kinds are known
from optlaws.cycles.interlocks.interlock import Interlock
from optlaws.entries.declared import ValueOf
from optlaws.entries.value_types import Listed

INTERLOCKS = Listed(ValueOf(Interlock), each="interlock")
