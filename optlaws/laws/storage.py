"""The storage of laws: as plain data or JSON text that names its format and its kind."""

from __future__ import annotations

import dataclasses
from abc import ABC
from collections.abc import Mapping
from math import inf
from typing import Any, ClassVar, Self

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText
from optlaws.lazy import Registry
from optlaws.numbers import bounded

FORMAT = 1


class StoredLaw(JsonText, ABC):
    """A value that turns into plain data and back without loss; each kind is a subclass that names itself.

    >>> from optlaws import PolynomialLaw
    >>> StoredLaw.kinds["polynomial"] is PolynomialLaw
    True
    """

    _json_name = "a law"
    _json_layout: ClassVar[Mapping[str, Any]] = {"allow_nan": False}

    kind: ClassVar[str]
    kinds: ClassVar[Registry[type[StoredLaw]]] = Registry("law")

    def __init_subclass__(cls, *, kind: str | None = None, **kwargs: object) -> None:
        super().__init_subclass__(**kwargs)
        if kind is not None:
            cls.kind = kind
            StoredLaw.kinds[kind] = cls

    def to_dict(self) -> dict[str, Any]:
        """The law as plain data (numbers, strings, lists), from which `from_dict` constructs an equal one.

        >>> from optlaws import MotionLaw, smoothstep
        >>> smoothstep(1).to_dict()
        {'format': 1, 'kind': 'polynomial', 'acceleration': [], 'a0': 0.0, 'b0': 1.0}
        """
        return {"format": FORMAT, "kind": self.kind, **contents(self)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The law that `to_dict` described.

        Raises
        ------
        InputError
            If the format, the kind or a key is unknown, a key is missing, or a number is not finite.

        Examples
        --------
        >>> from optlaws import MotionLaw, smoothstep
        >>> MotionLaw.from_dict(smoothstep(4).to_dict()) == smoothstep(4)
        True
        """
        fields = _opened(data)
        kind = fields.pop("kind", None)
        law = cls.kinds[kind] if isinstance(kind, str) and kind in cls.kinds else None
        if law is None or not issubclass(law, cls):
            known = sorted(name for name, heir in cls.kinds.items() if issubclass(heir, cls))
            raise InputError(f"kind of law {shortened(kind)} is unknown; known are {', '.join(known)}")
        return law._read(known_fields(law, fields, f"a {kind} law"))  # noqa: SLF001 - of the same kind

    @classmethod
    def _read(cls, fields: dict[str, Any]) -> Self:
        """The value of these contents; all its keys are there, and no other."""
        return cls(**fields)


class PlainNumbers(JsonText):
    """Frozen dataclasses of numbers and texts as plain data, where what is infinite is None.

    >>> from optlaws.mechanisms.drives.effort import Effort
    >>> effort = Effort(1.0, 0.2, 0.5, 2.0, 0.0, 2.0, 2.0, 0.3, 0.3, 0.3)
    >>> Effort.from_json(effort.to_json()) == effort
    True
    """

    def to_dict(self) -> dict[str, Any]:
        """The value as a plain JSON-able dict; what is infinite is None."""
        this: Any = self
        values = {field.name: getattr(this, field.name) for field in dataclasses.fields(this)}
        return {name: bounded(value) if isinstance(value, float) else value for name, value in values.items()}

    @classmethod
    def json_schema(cls) -> dict[str, Any]:
        """The JSON Schema of its plain data."""
        known = {"str": {"type": "string"}, "float": {"type": ["number", "null"]}}
        this: Any = cls
        properties = {field.name: known.get(str(field.type), {"type": "array"}) for field in dataclasses.fields(this)}
        return {"type": "object", "properties": properties, "required": [*properties], "additionalProperties": False}

    @classmethod
    def from_dict(cls, data: Any) -> Self:
        """The value that `to_dict` described.

        Raises
        ------
        InputError
            If a key is unknown or missing.
        """
        name = f"a {cls.__name__}"
        if not isinstance(data, Mapping):
            raise InputError(f"{name} must be a dict, got {type(data).__name__}")
        stored = known_fields(cls, data, name)
        return cls(**{key: _restored(value) for key, value in stored.items()})


def contents(value: Any) -> dict[str, Any]:
    """The fields of a dataclass as plain data: tuples as lists, what is stored itself as its own dict.

    >>> from optlaws.laws.segments import PolynomialSegment
    >>> contents(PolynomialSegment((1.0, 2.0)))
    {'acceleration': [1.0, 2.0], 'b0': 0.0}
    """
    return {field.name: _plain(getattr(value, field.name)) for field in dataclasses.fields(value)}


def known_fields(kind: type, fields: Mapping[str, Any], what: str) -> dict[str, Any]:
    """Contents whose keys are the fields of a dataclass; errors call them `what`.

    >>> from optlaws.laws.segments import PowerSegment
    >>> known_fields(PowerSegment, {"b0": 0.0, "b2": 1.0}, "a power segment")
    Traceback (most recent call last):
    optlaws.errors.InputError: a power segment has the keys b0, b1; 'b2' is unknown, 'b1' is missing
    """
    expected = [field.name for field in dataclasses.fields(kind)]
    problems = [f"{shortened(key)} is unknown" for key in fields if key not in expected]
    problems += [f"{key!r} is missing" for key in expected if key not in fields]
    if problems:
        raise InputError(f"{what} has the keys {', '.join(expected)}; {', '.join(problems)}")
    return dict(fields)


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(part) for part in value]
    return value.to_dict() if hasattr(value, "to_dict") else value


def _restored(value: Any) -> Any:
    return inf if value is None else tuple(value) if isinstance(value, list) else value


def _opened(data: Any) -> dict[str, Any]:
    if not isinstance(data, Mapping):
        msg = f"a law must be a dict, got {type(data).__name__}"
        raise InputError(msg)
    fields = dict(data)
    if (stated := fields.pop("format", None)) != FORMAT:
        msg = f"format of a law must be {FORMAT}, got {shortened(stated)}"
        raise InputError(msg)
    return fields
