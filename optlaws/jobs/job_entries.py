"""The entries that the problem file of every job has, and names of files of results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY
from pathlib import Path
from typing import Any, Self

from optlaws.entries.declared import Declared, declared, entry
from optlaws.entries.value_types import Text
from optlaws.errors import located
from optlaws.laws.catalogue.reading import with_files


@declared
class ProblemFile(Declared, title="a problem file"):
    """The entries that the problem file of every job has."""

    _: KW_ONLY
    job: str = entry(Text(), "What is to be done.", shown=False)
    title: str = entry(Text(), "Heading of the results.", example="A valve")
    text: str = entry(Text(empty=True), "What stands below the heading.", default="")

    @classmethod
    def read(cls, data: Mapping[str, Any], file: Path) -> Self:
        """The value of the entries of a file, beside which the files that it names are; an error names the file.

        >>> ProblemFile.read({"job": "cam", "titel": "A valve"}, Path("valve.toml"))
        Traceback (most recent call last):
        optlaws.errors.InputError: valve.toml: unknown entry of a problem file 'titel'; did you mean 'title'?
        """
        with located(str(file)):
            return cls.from_dict(with_files(data, file.parent))


def plain_name(name: str) -> str:
    """A name as files of results have it."""
    return "".join(letter if letter.isalnum() else "_" for letter in name.lower())
