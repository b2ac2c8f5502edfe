"""Internals of `optlaws.entries` that tests look at by themselves."""

from optlaws.entries.declared import Declared, Kinded, entries_of

__all__ = ["Declared", "Kinded", "entries_of"]
