"""Certificates as plain data: which keys they have, and of which type each value is."""

from __future__ import annotations

import json
from typing import Any, TypeVar

import msgspec

from optlaws.errors import InputError
from optlaws.files.typed import typed
from optlaws.synthesis.problem.problem import Problem

Stated = TypeVar("Stated")


class StatedContact(msgspec.Struct, forbid_unknown_fields=True):
    """What `Contact` holds."""

    constraint: str
    sign: float
    k: float
    multiplier: float
    direction: tuple[float, ...] = ()


class StatedCertificate(msgspec.Struct, forbid_unknown_fields=True):
    """What `Certificate.to_dict` writes."""

    problem: dict[str, Any]
    program: str
    tangent: float
    contacts: list[StatedContact]
    equations: tuple[float, ...]
    bound: float | None = None
    about: str = ""


class StatedStep(msgspec.Struct, forbid_unknown_fields=True):
    """What `Step` holds, or a `Cut`, which has nothing but a variable and a place."""

    variable: int
    side: int | None = None
    contacts: list[StatedContact] | None = None
    equations: tuple[float, ...] | None = None
    claim: float | None = None
    at: float | None = None


class StatedPowerCertificate(msgspec.Struct, forbid_unknown_fields=True):
    """What `PowerCertificate.to_dict` writes."""

    problem: dict[str, Any]
    claim: float
    points: tuple[float, ...]
    steps: list[StatedStep]
    bound: float | None = None
    about: str = ""


class StatedCell(msgspec.Struct, forbid_unknown_fields=True):
    """What `Cell` holds."""

    k: float
    reach: float
    sign: float
    contacts: list[StatedContact]
    equations: tuple[float, ...]


class StatedPeakCertificate(msgspec.Struct, forbid_unknown_fields=True):
    """What `PeakCertificate.to_dict` writes."""

    problem: dict[str, Any]
    constant: str
    claim: float
    cells: list[StatedCell]
    bound: float | None = None
    about: str = ""


def stated(data: object, kind: type[Stated], name: str) -> Stated:
    """Plain data as a value of which every key is known and of its type; `name` is what an error calls it.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is of another type or beyond double precision.

    Examples
    --------
    >>> stated({"constraint": "C", "sign": 1, "k": 0.25, "multiplier": 0.5}, StatedContact, "contact").k
    0.25
    >>> stated({"constraint": "C", "sign": 1, "k": "a", "multiplier": 0.5}, StatedContact, "contact")
    Traceback (most recent call last):
    optlaws.errors.InputError: this is not a contact: Expected `float`, got `str` - at `$.k`
    """
    try:
        return typed(as_json(data), kind)
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"this is not a {name}: {error}") from None


def as_json(data: object) -> Any:  # noqa: ANN401 - JSON
    """The data as its JSON text would be read: lists, not tuples, and floats of Python, not of numpy.

    Raises
    ------
    TypeError, ValueError, RecursionError
        If it has no JSON text.

    Examples
    --------
    >>> as_json({"points": (0.25, 0.5)})
    {'points': [0.25, 0.5]}
    """
    return json.loads(json.dumps(data, default=dict))


def problem_of(data: dict[str, Any]) -> Problem:
    """The problem that plain data describe.

    Raises
    ------
    InputError
        If they describe none.

    Examples
    --------
    >>> problem_of({"order": 4, "B": 10**400})
    Traceback (most recent call last):
    optlaws.errors.InputError: problem: ...
    """
    try:
        return Problem.from_dict(data)
    except (ArithmeticError, AttributeError, KeyError, RecursionError, TypeError, ValueError) as error:
        raise InputError(f"problem: {error}") from None
