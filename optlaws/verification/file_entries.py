"""Content of a file by place: solutions, certificates and laws, and the statements of objects around them.

Every key of a file is known: it belongs to an entry, to a row of a table or a front around entries, or it names
entries. Any other entry is refused, because nothing would prove it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import prod
from typing import Any

from optlaws.echo import shortened, unknown_key
from optlaws.entries.value_types import Choice, Listed, Number, ReadBy, Table, Text, ValueType, Whole
from optlaws.errors import InputError, located
from optlaws.files.reading import of_known_format
from optlaws.numbers import finite, real
from optlaws.synthesis.proof.certificate import Certificate
from optlaws.synthesis.proof.data import problem_of
from optlaws.synthesis.proof.no_law import ground_of
from optlaws.synthesis.stored_solutions import StatedSolutions
from optlaws.tolerances import OPTIMALITY_GAP

Data = Mapping[str, Any]

#: where nothing was found nothing is claimed; the last is what older files say
_NO_CLAIM = ("failed", "invalid", "not found")
NO_FILE = "not a file of solutions or certificates"

#: keys that only entries and their proofs have
_OF_PROOFS = {
    "certificate",
    "power_certificate",
    "peak_certificate",
    "contacts",
    "steps",
    "potential",
    "proof",
    "proofs",
}


#: kinds of entries by the keys that each has at least; the first that fits
_KINDS = (
    ("array", {"shape", "solutions"}),
    ("proven front", {"runs", "problem", "points"}),
    ("drive limit", {"plane", "potential"}),
    ("move limit", {"drive_limit", "unit", "dimension"}),
    ("least time", {"duration", "solution", "proofs"}),
    ("time front", {"minimise", "fastest", "points"}),
    ("overlap", {"goal", "axes", "given"}),
    ("axes", {"unit", "axes"}),
    ("cam", {"unit", "cam", "solutions"}),
    ("plan", {"cycle", "solutions"}),
    ("fastest cycle", {"given", "cycle", "proofs"}),
    ("solution", {"law", "certificate"}),
    ("law", {"law", "constants"}),
    ("certificate", {"problem", "contacts"}),
    ("certificate", {"problem", "steps"}),
    ("certificate", {"problem", "cells"}),
)


_ANY = ReadBy(lambda value: value, "anything")
_TABLES = Listed(Table(_ANY))
#: what stands around entries, by its kind and its keys, and the types of what nothing else reads
_KNOWN: dict[str, dict[str, ValueType]] = {
    "the row": {
        **dict.fromkeys(("solution", "asked", "proof"), _ANY),
        "status": Choice("optimal", "local", "inaccurate", "infeasible", *_NO_CLAIM),
    },
    "the front": {
        "over": Listed(Text()),
        "values": Listed(Listed(Number())),
        "points": Listed(_ANY),
        "failed": Listed(Number()),
        "errors": _TABLES,
        "about": Text(empty=True),
    },
    "the axes": {
        "unit": Choice("SI"),
        "axes": Table(_ANY),
        **dict.fromkeys(("interlocks", "overlap", "transitions"), _ANY),
        "about": Text(empty=True),
    },
    "the array of solutions": {
        **dict.fromkeys(StatedSolutions.__struct_fields__, _ANY),
        "shape": Listed(Whole()),
        "solutions": _TABLES,
    },
}


@dataclass(frozen=True)
class FileEntry:
    """A solution, certificate, law or array, with what the objects around it state; without data, that alone."""

    data: Data
    status: str | None = None  #: the status of its row
    problem: Any = None  #: the problem of its row, as plain data
    B: float | None = None  #: the peak velocity of its row
    values: Mapping[str, float] = field(default_factory=dict)  #: constants by name, in a front
    above: float | None = None  #: what its bound has to exceed, if its row is to have no law


def entries(data: Data) -> dict[str, FileEntry]:
    """The verifiable entries of a file by their places.

    >>> list(entries({"rows": [{"solution": {"law": {}, "constants": {}}}, {"about": "none"}]}))
    ['rows[0].solution']
    >>> entries({"rows": [{"solution": {"law": {}, "constants": {}}}, {"best_possible": 4.0}]})
    Traceback (most recent call last):
    optlaws.errors.InputError: ...rows[1].best_possible states 4.0 without a certificate
    """
    return dict(_walk(data, "", FileEntry({})))


def _inside(data: object, path: str = "") -> Iterator[tuple[str, Any]]:
    """The values of an object or a list, each with its place."""
    if isinstance(data, Mapping):
        yield from ((_place(path, name), value) for name, value in data.items())
    elif isinstance(data, list):
        yield from ((f"{path}[{i}]", value) for i, value in enumerate(data))


def _place(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _objects(data: object, path: str = "") -> Iterator[tuple[str, Data]]:
    """Every object, however deep, with its place."""
    if isinstance(data, Mapping):
        yield path, data
    for place, value in _inside(data, path):
        yield from _objects(value, place)


def holds_proof(data: object) -> bool:
    """Whether a solution, a limit or a part of a proof stands anywhere in data, however deep.

    >>> holds_proof({"moves": [{"solution": {"certificate": {}}}]}), holds_proof({"moves": [{"best_possible": 4.0}]})
    (True, False)
    """
    return any(_OF_PROOFS & table.keys() or kind_of(table) not in {None, "array", "law"} for _, table in _objects(data))


def laws_within(data: object) -> Iterator[tuple[str, Data]]:
    """Laws with their constants, however deep and whatever stands beside them, by place.

    >>> dict(laws_within({"cams": [{"law": {}, "constants": {}, "radius": 0.1}]}))
    {'cams[0]': {'law': {}, 'constants': {}}}
    """
    names = ("law", "constants")
    return ((path, {name: table[name] for name in names}) for path, table in _objects(data) if {*names} <= table.keys())


#: pairs of which the first is never above the second in results without proofs
_ORDERED = (("low", "high"), ("lower_bound", "objective"), ("too_small", "radius"), ("radius", "too_large"))


def contradictions(data: object) -> Iterator[tuple[str, str]]:
    """What contradicts itself in results without proofs, by place: bounds above what they are bounds of, no numbers.

    >>> list(contradictions({"best": {"lower_bound": 2.0, "objective": 1.0}}))
    [('best', 'lower_bound 2.0 is above objective 1.0')]
    """
    for path, table in _objects(data):
        for less, more in _ORDERED:
            low, high = table.get(less), table.get(more)
            if low is None or high is None or isinstance(high, str):  # a spring names its objective
                continue
            pair = real(low), real(high)
            if pair[0] is None or pair[1] is None:
                yield path, f"{less} {shortened(low)} and {more} {shortened(high)} are to be numbers"
            elif pair[0] > pair[1] + OPTIMALITY_GAP * max(abs(pair[0]), abs(pair[1])):
                yield path, f"{less} {low!r} is above {more} {high!r}"


def is_entry(data: Data) -> bool:
    """Whether this is what is verified by itself, whatever its other entries: no array of solutions, and no machine."""
    return kind_of(data) not in {None, "array", "axes"}


def kind_of(data: Data) -> str | None:
    """The kind of an entry, by the keys that it has at least; None of what is no entry.

    >>> kind_of({"law": {}, "constants": {}, "about": ""}), kind_of({"about": ""})
    ('law', None)
    """
    return next((kind for kind, keys in _KINDS if keys <= data.keys()), None)


def _stated(data: Data, title: str, path: str) -> dict[str, Any]:
    """The entries of a table, of which none is unknown, and each of its type where it is given."""
    name, types = path or title, _KNOWN[title]
    for key in data:
        if key not in types:
            raise InputError(f"{name}: {unknown_key(key, types, 'entry')}; leave out what is not checked")
    with located(name):
        return {key: None if data.get(key) is None else kind.read(data[key], key) for key, kind in types.items()}


def _walk(data: object, path: str, around: FileEntry) -> Iterator[tuple[str, FileEntry]]:
    if not isinstance(data, Mapping | list):
        if data is not None:
            raise InputError(f"{NO_FILE}: {path or 'it'} states {data!r:.40} without a certificate")
        return
    entries = of_known_format(data, path or "the file") if isinstance(data, Mapping) else {}
    if is_entry(entries):
        yield path, replace(around, data=entries)
    elif {"solution", "asked"} & entries.keys():
        yield from _row(_stated(entries, "the row", path), path, around)
    elif kind_of(entries) == "array":
        yield from _array(_stated(entries, "the array of solutions", path), entries, path)
    elif kind_of(entries) == "axes":
        yield from _axes(_stated(entries, "the axes", path), entries, path)
    elif "over" in entries:
        yield from _front(_stated(entries, "the front", path), path)
    elif "B" in entries:
        yield from _of_velocity(entries, path)
    else:
        yield from _members(entries if isinstance(data, Mapping) else data, path, around)


def _members(data: Data | list[Any], path: str, around: FileEntry) -> Iterator[tuple[str, FileEntry]]:
    for place, value in _inside(data, path):
        if place != _place(path, "about") or not isinstance(value, str):
            yield from _walk(value, place, around)


def _row(row: Data, path: str, around: FileEntry) -> Iterator[tuple[str, FileEntry]]:
    if row["asked"] is not None:
        with located(f"{path}.asked"):
            problem_of(row["asked"])
    context = replace(around, status=row["status"], problem=row["asked"])
    inside = [entry for name in ("solution", "proof") for entry in _walk(row[name], _place(path, name), context)]
    if not inside and row["status"] not in {None, *_NO_CLAIM}:
        inside = [(path, context)]
    yield from inside


def _array(array: Data, data: Data, path: str) -> Iterator[tuple[str, FileEntry]]:
    rows, shape = array["solutions"] or (), array["shape"] or ()
    if prod(shape) != len(rows):
        raise InputError(f"{path or 'the array'}: {len(rows)} solutions are not of shape {list(shape)}")
    for place, row in _inside(list(rows), _place(path, "solutions")):
        if is_entry(row):
            yield place, FileEntry(row)
        elif row.get("status") == "infeasible":
            yield from _no_law(row, place)
        elif {"error", "status"} != row.keys() - {"problem", "tried"} or row["status"] not in _NO_CLAIM:
            raise InputError(f"{NO_FILE}: {place} is neither a solution nor an error")
    if array["problems"] is not None:
        yield _place(path, "problems"), FileEntry(data)


def _axes(machine: Data, data: Data, path: str) -> Iterator[tuple[str, FileEntry]]:
    """The plan of each axis, the laws of run-ins and run-outs, and the machine where something is said of it."""
    for place, plan in _inside(machine["axes"], _place(path, "axes")):
        if not isinstance(plan, Mapping) or kind_of(plan) != "plan":
            raise InputError(
                f"{NO_FILE}: {place} has no plan, its cycle with the solutions, from which its numbers follow"
            )
        yield place, FileEntry(plan)
    for place, transition in _inside(machine["transitions"], _place(path, "transitions")):
        cam = transition.get("cam") if isinstance(transition, Mapping) else None
        for name in ("best", "least"):
            if isinstance(cam, Mapping) and cam.get(name) is not None:
                yield from _walk(cam[name], f"{place}.cam.{name}", FileEntry({}))
    if any(machine[name] is not None for name in ("interlocks", "overlap", "transitions")):
        yield path, FileEntry(data)


def _no_law(row: Data, path: str) -> Iterator[tuple[str, FileEntry]]:
    """The proof that the problem of a row has no law, converted to that problem from any other."""
    proof: Any = row.get("proof")
    ground = None
    if isinstance(proof, Mapping):
        with located(f"{path}.problem"):
            problem = problem_of(row.get("problem", {}))
        ground = ground_of(problem, Certificate.from_dict(proof))
    if ground is None:
        yield path, FileEntry({}, status="infeasible")
    else:
        moved = {**proof, "problem": ground.problem.to_dict()}
        yield f"{path}.proof", FileEntry(moved, status="infeasible", above=ground.above)


def _front(front: Data, path: str) -> Iterator[tuple[str, FileEntry]]:
    if missing := [key for key in ("over", "values", "points") if front[key] is None]:
        raise InputError(f"{path or 'the front'} needs {', '.join(missing)}")
    over, values_of_points, points = front["over"], front["values"], front["points"]
    if len(values_of_points) != len(points) or any(len(row) != len(over) for row in values_of_points):
        raise InputError(f"{path or 'the front'}: values must be as many as points, one for each of {list(over)}")
    if len(set(over)) < len(over):
        raise InputError(f"{path or 'the front'}: it is over the same constant twice: {list(over)}")
    for values, (place, point) in zip(values_of_points, _inside(list(points), _place(path, "points")), strict=True):
        inside = list(_walk(point, place, FileEntry({}, values=dict(zip(over, values, strict=True)))))
        if not inside:
            raise InputError(f"{NO_FILE}: {place} has no law, but its values claim one")
        yield from inside
    for place, row in _inside(list(front["errors"] or ()), _place(path, "errors")):
        if row.get("status") not in _NO_CLAIM:
            yield from _no_law(row, place)


def _of_velocity(data: Data, path: str) -> Iterator[tuple[str, FileEntry]]:
    """The row of a table whose laws have a peak velocity."""
    # printed numbers are kept as they are printed
    printed = data["B"]
    try:
        B = finite(float(printed) if isinstance(printed, str) else printed, f"{path}.B")
    except ValueError:
        raise InputError(f"{path}.B must be a number, got {printed!r:.40}") from None
    inside = list(_members({key: value for key, value in data.items() if key != "B"}, path, FileEntry({}, B=B)))
    if not any("problem" in entry.data for _, entry in inside):
        raise InputError(f"{NO_FILE}: {path}.B states {B!r} without a certificate")
    yield from inside
