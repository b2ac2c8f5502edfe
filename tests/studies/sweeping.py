"""Studies for tests, and their rows without what differs from run to run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import msgspec

from optlaws import run_study
from tests.internals.studies import Serial, Study, StudyPoint, Task, blocks

SMALL: dict[str, Any] = {
    "problem": {"order": 4, "degree": 5},
    "vary": {"minimise": ["C", "rms_c"], "B": {"from": 1.1, "to": 2.4, "steps": 14}},
    "chunk": 5,
}


def plain(row: StudyPoint) -> dict[str, Any]:
    return {**msgspec.structs.asdict(row), "law": msgspec.json.decode(row.stored), "stored": None}


def rows(study: Study) -> list[dict[str, Any]]:
    return [{**plain(row), "seconds": None} for row in study]


def solved(task: Task) -> list[dict[str, Any]]:
    """The rows of a chunk, solved in this process."""
    return [plain(msgspec.json.decode(row, type=StudyPoint)) for block in blocks(task) for row in block]


def serially(asked: Mapping[str, Any], out: Path) -> Study:
    return run_study(asked, out, executor=Serial())


def troubled(name: str, **more: object) -> dict[str, Any]:
    """A study of which the third of four points is in for it."""
    return {
        "problem": {"order": 4, "degree": 5, "minimise": name},
        "vary": {"B": [1.5, 1.6, 1.7, 1.8]},
        "imports": ["tests.studies.troubles"],
        "chunk": 4,
        **more,
    }
