"""Reading what a job wrote."""

import csv
from pathlib import Path


def table(file: Path) -> list[dict[str, str]]:
    """The rows of a CSV file below its first line, which says where they come from."""
    return list(csv.DictReader(file.read_text("utf-8").splitlines()[1:]))
