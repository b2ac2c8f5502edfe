"""A small problem file for every job, the data that it names, and what is wrong with it when it is changed."""

import tomllib
from dataclasses import dataclass, field

from tests.documents import ROOT


@dataclass(frozen=True)
class Example:
    """A problem file with the files beside it; the changes that make it wrong: old text, new text, what is said."""

    text: str
    wrong: list[tuple[str, str, str]]
    beside: dict[str, str] = field(default_factory=dict)
    wrong_beside: list[tuple[str, str, str]] = field(default_factory=list)


KNOWN = tomllib.loads((ROOT / "tests" / "reference" / "jobs.toml").read_text("utf-8"))
EXAMPLES = {name: Example(**entries) for name, entries in KNOWN.items()}
SOLUTIONS = EXAMPLES["solutions"].text
(SOLUTIONS_PRINTED,) = EXAMPLES["solutions"].beside.values()
