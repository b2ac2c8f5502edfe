"""Studies for tests, and their rows without what differs from run to run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from msgspec.structs import asdict

from optlaws.studies.executor import Serial
from optlaws.studies.run import run_study
from optlaws.studies.study import Study

SMALL: dict[str, Any] = {
    "problem": {"order": 4, "degree": 5},
    "vary": {"minimise": ["C", "rms_c"], "B": {"from": 1.1, "to": 2.4, "steps": 14}},
    "chunk": 5,
}


def rows(study: Study) -> list[dict[str, Any]]:
    return [{**asdict(row), "law": row.stored_law(), "seconds": None} for row in study._rows()]


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
