"""The command `optlaws verify`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from optlaws.errors import InputError, OptlawsError


class NotProven(OptlawsError):  # noqa: N818
    """A file claims something that is false or not proven; the message says what.

    Examples
    --------
    >>> issubclass(NotProven, OptlawsError)
    True
    """


def verify(*files: Path, as_json: Annotated[bool, Parameter(name="--json")] = False) -> None:
    """Check solutions or certificates with every rounding enclosed; no solver takes part.

    Ends with 0 if every claim of every file is proven, 1 if one is false or not proven.

    Parameters
    ----------
    files
        JSON files that `optlaws solve --output` wrote, or certificates.
    as_json
        Print one JSON object, with an entry for each file, on stdout and nothing else.
    """
    from optlaws.verification import verify as checked

    if not files:
        raise InputError("name at least one file that `optlaws solve --output FILE` wrote")
    found = {str(file): checked(file) for file in files}
    if as_json:
        print(json.dumps({name: one.to_dict() for name, one in found.items()}))  # noqa: T201
    else:
        for name, one in found.items():
            print(f"{name}: {'proven' if one.proven else 'NOT PROVEN'}\n{one}\n")  # noqa: T201
    failed = [f"{name}: {claim}" for name, one in found.items() for claim in one.claims if not claim.proven]
    if failed:
        raise NotProven("\n".join(failed))
