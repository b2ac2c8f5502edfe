"""The command `optlaws verify`: proofs in files, checked with exact arithmetic."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from optlaws.cli.app import NotProven, PartlyChecked
from optlaws.cli.options import takes
from optlaws.cli.show import Answer
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.verification import Claim, Verification

_INTERLOCK = "interlock "


@takes()
def verify(*files: Path) -> Answer:
    """Check solutions or certificates with every rounding enclosed; no solver takes part.

    No picture is drawn: a verdict has no curve, and `optlaws law FILE --plot` draws the law of a solution.

    Ends with 0 if every proof of every file holds and every other number is computed again in doubles and agrees, 1 if
    something is false or not proven, 2 if a file cannot be checked, 3 if nothing is false and something could not be
    checked. The last line counts all three kinds.

    Parameters
    ----------
    files
        JSON files that `optlaws solve --output` wrote, certificates, or results such as laws.json and cycle.json.
    """
    if not files:
        raise InputError("name at least one file that `optlaws solve --output FILE` wrote")
    verifications = {
        f"{file}: {place}" if place else str(file): verification
        for file in files
        for place, verification in _verified(file).items()
    }
    alone = len(verifications) == len(files)
    lines = [_in_words(name, verification, whole=alone) for name, verification in verifications.items()]
    lines.append(_in_all(verifications.values()))
    return Answer(
        lambda: lines,
        lambda: {name: verification.results() for name, verification in verifications.items()},
        failure=_failure(verifications),
    )


def _failure(verifications: Mapping[str, Verification]) -> NotProven | None:
    """How much is not proven or, if nothing is false, could not be checked; the answer says what."""
    every = verifications.values()
    failed = sum(not claim.proven for each in every for claim in each.claims)
    if failed:
        return NotProven(f"{_claims(failed)} not proven")
    partly = sum(len(each.unchecked) for each in every)
    return PartlyChecked(f"{_claims(partly)} not checked") if partly else None


def _claims(count: int) -> str:
    return "1 claim is" if count == 1 else f"{count} claims are"


def _numbers(*verifications: Verification) -> dict[str, int]:
    """How many claims are not proven, proven, recomputed in doubles and not checked."""
    claims = [claim for each in verifications for claim in each.claims]
    proven = sum(claim.proven for claim in claims)
    again, left = (sum(len(getattr(each, name)) for each in verifications) for name in ("recomputed", "unchecked"))
    return {"not proven": len(claims) - proven, "proven": proven, "recomputed in doubles": again, "not checked": left}


def _in_all(verifications: Iterable[Verification]) -> str:
    """The last line: how many claims are of each kind, and how many are not proven if any."""
    counts = _numbers(*verifications)
    return ", ".join(f"{count} {word}" for word, count in counts.items() if count or word != "not proven")


def _verified(file: Path) -> dict[str, Verification]:
    """The verifications of a file; of results that optlaws wrote without proofs, of their laws alone."""
    from optlaws.files import reading
    from optlaws.files.writing import MARK
    from optlaws.verification import verify as verify_one
    from optlaws.verification import verify_all
    from optlaws.verification.file_entries import contradictions, holds_proof, laws_within
    from optlaws.verification.result import Claim

    try:
        return dict(verify_all(file))
    except InputError as error:
        stored = reading.json_file(file)
        about = stored if isinstance(stored, dict) else {}
        if str(about.get("format")).startswith(("optlaws cycle", "optlaws axes")):
            raise InputError(
                f"{file}: it has the entries of a cycle or of axes, and claims nothing of their laws: Cycle.from_json "
                "or Axes.from_json solves them again; the solutions of a cycle are stored with their proofs"
            ) from None
        if MARK not in str(about.get("about")) or "problem" in about or holds_proof(about):
            text = str(error)
            raise InputError(text if str(file) in text else f"{file}: {text}") from None
    parts: dict[str, Verification] = {}
    for place, law in laws_within(about):
        try:
            parts[place] = verify_one(law)
        except InputError as error:
            parts[place] = _unchecked("the law", str(error))
    names = ", ".join(name for name, value in about.items() if name not in {"about", "unit"} and value is not None)
    why = "results without proofs, which the file of --output, the explorer and to_dict() of a solution have"
    claims = [Claim(place, proven=False, detail=detail) for place, detail in contradictions(about)]
    return parts | {"": _unchecked("the file", f"{why}; nothing but laws is computed again of: {names}", claims)}


def _unchecked(name: str, why: str, claims: Sequence[Claim] = ()) -> Verification:
    """A verification of what is not computed again, beside claims that contradict themselves."""
    from optlaws.verification import Verification
    from optlaws.verification.result import Claim

    claim = Claim(name, proven=False, detail=why, checked=False)
    return Verification(problem=None, bound=None, claims=tuple(claims), unchecked=(claim,))


def _in_words(name: str, verification: Verification, *, whole: bool) -> str:
    from optlaws.verification.result import every_claim

    if whole:
        word = "not proven" if not verification.proven else "proven" if verification.claims else "not checked"
        if word == "proven" and verification.unchecked:
            word = f"proven, but {_claims(len(verification.unchecked))} not checked"
        return f"{name}: {word}\n{verification}\n"
    bound = "" if verification.bound is None else f", lower bound {verification.bound!r}"
    gap = "" if verification.gap is None else f", gap at most {verification.gap:.1e}"
    # of a machine each interlock is what is asked for; of laws only what is not proven
    shown = [claim for claim in every_claim(verification) if not claim.proven or claim.name.startswith(_INTERLOCK)]
    counts = ", ".join(f"{_claims(count)} {word}" for word, count in _numbers(verification).items() if count)
    return "\n".join([f"{name}: {counts or 'no claim'}{bound}{gap}", *map(str, shown)])
