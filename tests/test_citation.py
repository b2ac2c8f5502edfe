"""The citation file says of the package what its metadata says."""

import tomllib
from datetime import date
from pathlib import Path

import yaml  # type: ignore[import-untyped]

ROOT = Path(__file__).parents[1]


def test_the_citation_file_agrees_with_the_metadata() -> None:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    # The four keys that version 1.2.0 of the format requires.
    assert {"cff-version", "message", "title", "authors"} <= citation.keys()
    assert citation["cff-version"] == "1.2.0"
    assert citation["type"] == "software"
    assert isinstance(citation["date-released"], date)
    assert citation["authors"] == project["authors"]
    assert citation["abstract"] == project["description"] + "."
    for key, name in (("title", "name"), ("version", "version"), ("license", "license"), ("keywords", "keywords")):
        assert citation[key] == project[name], key
