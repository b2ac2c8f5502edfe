"""Figures of others, with their sources."""

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

REFERENCE = Path(__file__).parents[1] / "reference"


@cache
def numbers() -> dict[str, Any]:
    return tomllib.loads((REFERENCE / "published_numbers.toml").read_text(encoding="utf-8"))


def cases(name: str) -> list[dict[str, Any]]:
    """All cases of a table, or of all tables of the name, each with the other keys of its table."""
    table = numbers()[name]
    tables = table if isinstance(table, list) else [table]
    common = [{key: value for key, value in one.items() if key != "cases"} for one in tables]
    return [{**shared, **case} for shared, one in zip(common, tables, strict=True) for case in one["cases"]]
