"""What two files say: words and structure must be equal, numbers but for rounding."""

import json
from typing import Any

import pytest

from tests.internals.files import say_the_same

LAW: dict[str, Any] = {
    "status": "optimal",
    "objective": 5.57,
    "best_possible": None,
    "constants": {"B": {"value": 1.53, "k": 0.5}},
    "gap": "1e-10",
    "z": [1e6, 1.0],
    "starts": [5.57, 5.58],
    "certificate": {"program": "linear", "bound": 5.57, "contacts": [{"k": 0.1, "multiplier": 1.0}]},
}


@pytest.mark.parametrize(
    ("change", "same"),
    [
        ({"objective": 5.57 * (1 + 1e-9)}, True),
        ({"objective": 5.57 * (1 + 2e-8)}, False),
        ({"objective": None}, False),
        ({"status": "local"}, False),
        ({"best_possible": 0.0}, False),
        ({"more": 1}, False),
        # the place of a smooth peak, not its size
        ({"constants": {"B": {"value": 1.53, "k": 0.5 + 1e-7}}}, True),
        ({"constants": {"B": {"value": 1.53 + 1e-7, "k": 0.5}}}, False),
        ({"gap": "1e-9"}, True),
        ({"gap": "1e-7"}, False),
        # in the scale of the list
        ({"z": [1e6, 1.001]}, True),
        ({"z": [1e6, 1.1]}, False),
        ({"z": [1e6, 1.0, 0.0]}, False),
        ({"starts": [5.57]}, True),
        # what a proof proves, not how
        ({"certificate": {"program": "linear", "bound": 5.57, "contacts": []}}, True),
        ({"certificate": {"program": "linear", "bound": 5.5, "contacts": []}}, False),
        ({"certificate": {"program": "conic", "bound": 5.57, "contacts": []}}, False),
    ],
)
def test_json(change: dict[str, Any], *, same: bool) -> None:
    first, second = (json.dumps(data).encode() for data in (LAW, LAW | change))
    assert say_the_same(first, second, ".json") is same
    assert say_the_same(second, first, ".json") is same


@pytest.mark.parametrize(
    ("first", "second", "same"),
    [
        ("| C |\n|---|\n| 5.572139 |", "| C   |\n|-----|\n| 5.57214 |", True),
        ("C = 5.572139", "C = 5.572140", True),
        ("C = 5.572139", "C = 5.572141", False),
        # few digits are meant so
        ("C = 5.57", "C = 5.58", False),
        ("row 103456", "row 103457", False),
        ("gap 1e-10", "gap 1e-9", True),
        ("gap 1e-8", "gap 1e-7", False),
        ("C = 5.572139", "D = 5.572139", False),
        ("C = 5.572139", "C = 5.572139 or so", False),
        ("law 0307a1.234567", "law 0307a1.234568", False),
    ],
)
def test_tables(first: str, second: str, *, same: bool) -> None:
    for kind in (".csv", ".md"):
        assert say_the_same(first.encode(), second.encode(), kind) is same
    assert not say_the_same(first.encode(), second.encode(), ".txt")


def test_pictures() -> None:
    line = '<path id="p{0}" d="M {1} 2" style="opacity: {2}; stroke: #{3}"/><use href="#p{0}"/>'
    drawn = line.format("0123456789", "201.214027", 0.3, "1e5000")
    for parts, same in (
        (("abcdef0123", "201.214027", 0.3, "1e5000"), True),
        (("0123456789", "201.24", 0.3, "1e5000"), True),
        (("0123456789", "201.294027", 0.3, "1e5000"), False),
        (("0123456789", "201.214027", 0.32, "1e5000"), False),
        (("0123456789", "201.214027", 0.3, "1e5001"), False),
    ):
        assert say_the_same(drawn.encode(), line.format(*parts).encode(), ".svg") is same
    assert not say_the_same(
        drawn.encode(), drawn.replace('href="#p0123456789"', 'href="#p0000000000"').encode(), ".svg"
    )


def test_fewer_digits_may_mean_something() -> None:
    tables = [f"| 0510 | 3 | {C} |".encode() for C in ("9.82783", "9.82776", "9.8348")]
    assert say_the_same(tables[0], tables[1], ".md", digits=4)
    assert not say_the_same(tables[0], tables[1], ".md")
    assert not say_the_same(tables[0], tables[2], ".md", digits=4)
    assert say_the_same(b'{"C": 9.82783}', b'{"C": 9.82776}', ".json", digits=4)


def test_what_cannot_be_read_is_not_the_same() -> None:
    for kind in (".json", ".csv", ".svg"):
        assert not say_the_same(b"\xff", b"{}", kind)
    assert not say_the_same(b"{", b"{}", ".json")


@pytest.mark.parametrize(
    ("other", "same"),
    [
        ("M 1 2 \nL 5 6 \nL 5 9 \n", True),
        ("M 1 2 \nL 3.02 4 \nL 4 5 \nL 5 6 \nL 5 9 \n", True),
        ("M 1 2 \nL 3.2 4 \nL 5 6 \nL 5 9 \n", False),
        ("M 1 2 \nL 3 4 \nL 5 6 \n", False),
    ],
)
def test_a_line_may_have_more_places_on_its_way(other: str, *, same: bool) -> None:
    line, other = (f'<path d="{path}" class="line"/>' for path in ("M 1 2 \nL 3 4 \nL 5 6 \nL 5 9 \n", other))
    assert say_the_same(line.encode(), other.encode(), ".svg") is same
    assert say_the_same(other.encode(), line.encode(), ".svg") is same
