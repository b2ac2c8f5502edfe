"""The command `optlaws verify`: proofs in files, checked with exact arithmetic."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.cli.app import NotProven, PartlyChecked
from optlaws.cli.options import AsJson
from optlaws.cli.show import print_json
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.verification import Verification


def verify(*files: Path, as_json: AsJson = False) -> None:
    """Check solutions or certificates with every rounding enclosed; no solver takes part.

    No picture is drawn: a verdict has no curve, and `optlaws law FILE --plot` draws the law of a solution.

    Ends with 0 if every claim of every file is proven, 1 if one is false or not proven, 2 if a file cannot be checked,
    3 if nothing is false and something was only computed again in doubles.

    Parameters
    ----------
    files
        JSON files that `optlaws solve --output` wrote, certificates, or the laws.json of a table.
    """
    if not files:
        raise InputError("name at least one file that `optlaws solve --output FILE` wrote")
    verifications = {
        f"{file}: {place}" if place else str(file): verification
        for file in files
        for place, verification in _verified(file).items()
    }
    if as_json:
        print_json({name: verification.results() for name, verification in verifications.items()})
    else:
        for name, verification in verifications.items():
            word = "not proven" if not verification.proven else "proven" if verification.claims else "not checked"
            alone = len(verifications) == len(files)
            print(f"{name}: {word}\n{verification}\n" if alone else _line(name, word, verification))
    failed = [
        f"{name}: {claim}"
        for name, verification in verifications.items()
        for claim in verification.claims
        if not claim.proven
    ]
    if failed:
        raise NotProven("\n".join(failed))
    partly = [f"{name}: {claim}" for name, verification in verifications.items() for claim in verification.unchecked]
    if partly:
        raise PartlyChecked("\n".join(partly))


def _verified(file: Path) -> dict[str, Verification]:
    """The verifications of a file; of results that optlaws wrote without proofs, of their laws alone."""
    from optlaws.files import reading
    from optlaws.files.writing import MARK
    from optlaws.verification import verify_all
    from optlaws.verification.file_entries import holds_proof, laws_within

    try:
        return dict(verify_all(file))
    except InputError as error:
        about = reading.json_file(file)
        if isinstance(about, dict) and str(about.get("format")).startswith(("optlaws cycle", "optlaws axes")):
            raise InputError(
                f"{file}: it has the entries of a cycle or of axes, and claims nothing of their laws: Cycle.from_json "
                "or Axes.from_json solves them again; the solutions of a cycle are stored with their proofs"
            ) from None
        written = (
            isinstance(about, dict)
            and MARK in str(about.get("about"))
            and "problem" not in about
            and not holds_proof(about)
        )
        if not written:
            text = str(error)
            raise InputError(text if str(file) in text else f"{file}: {text}") from None
        return {**{place: _law(law) for place, law in laws_within(about)}, "": _without_proofs(about)}


def _without_proofs(about: Mapping[str, Any]) -> Verification:
    """Results whose numbers are not computed again: their entries by name, and what in them contradicts itself."""
    from optlaws.verification import Verification
    from optlaws.verification.file_entries import contradictions
    from optlaws.verification.result import Claim

    names = ", ".join(name for name, value in about.items() if name not in {"about", "unit"} and value is not None)
    why = "results without proofs, which the file of --output, the explorer and to_dict() of a solution have"
    unchecked = Claim(
        "the file", proven=False, detail=f"{why}; nothing but laws is computed again of: {names}", checked=False
    )
    claims = tuple(Claim(place, proven=False, detail=detail) for place, detail in contradictions(about))
    return Verification(problem=None, bound=None, claims=claims, unchecked=(unchecked,))


def _law(data: Mapping[str, Any]) -> Verification:
    from optlaws import verification

    try:
        return verification.verify(data)
    except InputError as error:
        return _unchecked("the law", str(error))


def _unchecked(name: str, why: str) -> Verification:
    from optlaws.verification import Verification
    from optlaws.verification.result import Claim

    claim = Claim(name, proven=False, detail=why, checked=False)
    return Verification(problem=None, bound=None, unchecked=(claim,))


def _line(name: str, word: str, verification: Verification) -> str:
    bound = "" if verification.bound is None else f", no law below {verification.bound!r}"
    gap = "" if verification.gap is None else f", gap at most {verification.gap:.1e}"
    return f"{name}: {word}, {len(verification.claims)} claims{bound}{gap}"
