"""Certificates as plain data: which keys they have, of which type each value is, and which tree they write down."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any, TypeVar

import msgspec

from optlaws.errors import InputError
from optlaws.files.problem_file import typed
from optlaws.files.reading import of_known_format
from optlaws.synthesis.problem.constants import present_name
from optlaws.synthesis.problem.problem import Problem
from optlaws.synthesis.proof.nodes import Contact, Leaf, Node, PlaceRange, Split, Tightening

Stated = TypeVar("Stated")


class StatedContact(msgspec.Struct, forbid_unknown_fields=True):
    """The entries of a contact in a file."""

    constraint: str
    sign: float
    k: float
    multiplier: float
    direction: tuple[float, ...] = ()


class StatedLeaf(msgspec.Struct, forbid_unknown_fields=True):
    """A certificate of one leaf."""

    problem: dict[str, Any]
    program: str
    tangent: float
    contacts: list[StatedContact]
    equations: tuple[float, ...]
    bound: float | None = None
    about: str = ""


class StatedStep(msgspec.Struct, forbid_unknown_fields=True):
    """A leaf or a tightening of a box, or a split, which has nothing but a variable and a place."""

    variable: int
    side: int | None = None
    contacts: list[StatedContact] | None = None
    equations: tuple[float, ...] | None = None
    claim: float | None = None
    at: float | None = None


class StatedBoxes(msgspec.Struct, forbid_unknown_fields=True):
    """A certificate whose regions are boxes of velocities and constants: its tree, node by node."""

    problem: dict[str, Any]
    claim: float
    points: tuple[float, ...]
    steps: list[StatedStep]
    bound: float | None = None
    about: str = ""


class StatedCell(msgspec.Struct, forbid_unknown_fields=True):
    """A leaf over the places within reach of k, at which the peak has a sign."""

    k: float
    reach: float
    sign: float
    contacts: list[StatedContact]
    equations: tuple[float, ...]


class StatedPlaces(msgspec.Struct, forbid_unknown_fields=True):
    """A certificate whose regions are places of a peak; its leaves state the splits."""

    problem: dict[str, Any]
    constant: str
    claim: float
    cells: list[StatedCell]
    bound: float | None = None
    about: str = ""


def stated(data: object, kind: type[Stated], name: str) -> Stated:
    """Plain data as a typed value, in which every key must be known; errors call it `name`.

    >>> stated({"constraint": "C", "sign": 1, "k": 0.25, "multiplier": 0.5}, StatedContact, "contact").k
    0.25
    >>> stated({"constraint": "C", "sign": 1, "k": "a", "multiplier": 0.5}, StatedContact, "contact")
    Traceback (most recent call last):
    optlaws.errors.InputError: this is not a contact: Expected `float`, got `str` - at `$.k`
    """
    entries = of_known_format(data, f"the {name}") if isinstance(data, Mapping) else data
    try:
        return typed(as_json(entries), kind)
    except (TypeError, ValueError, RecursionError) as error:
        raise InputError(f"this is not a {name}: {error}") from None


def stated_certificate(data: object) -> StatedLeaf | StatedBoxes | StatedPlaces:
    """The entries of a certificate, in whichever of three ways its tree is written."""
    keys = data.keys() if isinstance(data, Mapping) else ()
    if "steps" in keys:
        return stated(data, StatedBoxes, "certificate")
    if "cells" in keys:
        return stated(data, StatedPlaces, "certificate")
    return stated(data, StatedLeaf, "certificate")


def as_json(data: object) -> Any:
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

    >>> problem_of({"order": 4, "B": 10**400})
    Traceback (most recent call last):
    optlaws.errors.InputError: problem: ...
    """
    try:
        return Problem.from_dict(data)
    except (ArithmeticError, AttributeError, KeyError, RecursionError, TypeError, ValueError) as error:
        raise InputError(f"problem: {error}") from None


def contacts_of(entries: Sequence[StatedContact]) -> tuple[Contact, ...]:
    """The contacts that entries of a file describe."""
    stated = (msgspec.structs.astuple(contact) for contact in entries)
    return tuple(Contact(present_name(constraint), *others) for constraint, *others in stated)


def sum_of(leaf: Leaf) -> dict[str, Any]:
    """The contacts and equations of a leaf as plain data."""
    return {"contacts": [asdict(contact) for contact in leaf.contacts], "equations": list(leaf.equations)}


def brief_sum_of(leaf: Leaf) -> dict[str, Any]:
    """The sum of a leaf as plain data, without empty directions of contacts."""
    plain = sum_of(leaf)
    contacts = [{name: value for name, value in contact.items() if value != ()} for contact in plain["contacts"]]
    return {**plain, "contacts": contacts}


def steps(tree: Sequence[Node]) -> list[dict[str, Any]]:
    """The nodes of a tree over boxes as plain data; a leaf is a step of the variable -1."""
    return [asdict(node) if isinstance(node, Split) else _step(node) for node in tree]


def _step(node: Leaf) -> dict[str, Any]:
    variable, side = (node.variable, node.side) if isinstance(node, Tightening) else (-1, 1)
    return {"variable": variable, "side": side, **brief_sum_of(node), "claim": node.claim}


def node_of(entries: StatedStep) -> Node:
    """The node of a tree over boxes that a step describes."""
    of_leaf = (entries.side, entries.contacts, entries.equations, entries.claim)
    if entries.at is not None and of_leaf == (None, None, None, None):
        return Split(entries.variable, entries.at)
    if entries.at is not None or None in of_leaf:
        raise InputError("this is not a certificate: a step has side, contacts, equations and claim, a split has at")
    contacts, equations, claim = contacts_of(entries.contacts or ()), entries.equations or (), entries.claim
    tightening = Tightening(contacts, equations, claim or 0.0, variable=entries.variable, side=entries.side or 0)
    return tightening if entries.variable != -1 else Leaf(contacts, equations, claim or 0.0)


def cells(tree: Sequence[Node], roots: Sequence[PlaceRange]) -> list[dict[str, Any]]:
    """The leaves of a tree over the places of a peak as plain data, each with its range."""
    ranges, written = list(roots), []
    for node in tree:
        if not ranges:
            break
        here = ranges.pop()
        if isinstance(node, Split):
            ranges += here.parts(node.at)
        else:
            written.append({"k": here.k, "reach": here.reach, "sign": here.sign, **sum_of(node)})
    return written


def tree_of_cells(entries: Sequence[StatedCell], roots: Sequence[PlaceRange]) -> tuple[Node, ...]:
    """The tree whose leaves were stated with their ranges."""
    left = [(PlaceRange(cell.sign, cell.k - cell.reach, cell.k + cell.reach), cell) for cell in entries]
    nodes: list[Node] = []
    for root in reversed(roots):
        nodes += _divided(root, sorted((pair for pair in left if root.holds(pair[0])), key=lambda pair: pair[0].low))
        left = [pair for pair in left if not root.holds(pair[0])]
    if left:
        raise InputError("this is not a certificate: its cells are not those places at which the peak may be")
    return tuple(nodes)


def _divided(root: PlaceRange, leaves: list[tuple[PlaceRange, StatedCell]]) -> Iterator[Node]:
    """A range divided down to the leaves in it, given in ascending order, in the middle where they allow it."""
    ranges = [(root, leaves)]
    while ranges:
        here, inside = ranges.pop()
        if len(inside) == 1 and inside[0][0] == here:
            cell = inside[0][1]
            yield Leaf(contacts_of(cell.contacts), cell.equations)
            continue
        edges = [place.high for place, _ in inside[:-1]]
        if not edges or not here.low < edges[0] <= edges[-1] < here.high:
            raise InputError("this is not a certificate: its cells leave out places of the peak, or overlap")
        first = min(range(len(edges)), key=lambda i: abs(edges[i] - here.k))
        yield Split(0, edges[first])
        above, below = here.parts(edges[first])
        ranges += [(above, inside[first + 1 :]), (below, inside[: first + 1])]
