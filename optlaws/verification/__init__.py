"""Proofs checked with every rounding enclosed, without a solver: the claims of a file, and the proven ones.

python-flint computes; it is imported at the first use.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.lazy import imported, process_lock

if TYPE_CHECKING:
    from optlaws.laws import MotionLaw
    from optlaws.synthesis.proof.certificate import Certificate
    from optlaws.verification.result import Claim, Verification

# python-flint has one precision for the process: what one thread asks for would be another's
_precision = process_lock()

__all__ = ["Claim", "Verification", "enclosures", "exact_bound", "verify", "verify_all"]


def verify(source: Mapping[str, Any] | Path | str) -> Verification:
    """Check a solution or a certificate: the law's constraints and constants, and the lower bound.

    Parameters
    ----------
    source
        What `Solution.to_dict()` or `Certificate.to_dict()` returned, or a JSON file with it, such as
        ``optlaws solve --output FILE`` writes.

    Raises
    ------
    InputError
        If it is neither, or something in it is of an unknown kind or no finite number.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Chebyshev(9)))
    >>> verification = verify(solution.to_dict())
    >>> verification.proven, round(verification.bound, 9), abs(verification.gap) < 1e-12
    (True, 4.647776025, True)
    """
    with _precision:
        from optlaws.verification import claims

        return claims.verify(source)


def verify_all(source: Mapping[str, Any] | Path | str) -> dict[str, Verification]:
    """Check everything that a file holds, such as the laws of a table, by where it is.

    Solutions and certificates are checked as by `verify`, and the constants of laws that stand alone.

    Raises
    ------
    InputError
        As `verify`; and if something is claimed without a certificate.

    Examples
    --------
    >>> import optlaws
    >>> law = optlaws.smoothstep(2)
    >>> verification = verify_all({"printed": [{"law": law.to_dict(), "constants": law.constants.to_dict()}]})
    >>> [(place, answer.proven) for place, answer in verification.items()]
    [('printed[0]', True)]
    """
    with _precision:
        from optlaws.verification import claims

        return claims.verify_all(source)


def exact_bound(certificate: Certificate) -> Fraction | None:
    """The lower bound that a certificate proves, rounded down; None if it proves nothing.

    Of a proof that no law exists, it is by how much the constraints contradict each other: above 0 if it stands.

    Raises
    ------
    InputError
        If its laws or one of its constants are of an unknown kind.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Chebyshev(9)))
    >>> abs(float(exact_bound(solution.certificate)) - solution.certificate.bound) < 1e-9
    True
    """
    with _precision:
        from optlaws.verification.exact import bound

        return bound.prove(certificate).value


def enclosures(law: MotionLaw) -> dict[str, tuple[float, float]]:
    """Floats below and above B, C, D, J and rms_c of the very function a law's numbers describe.

    Where a derivative jumps by more than rounding, those above it are infinite.

    Raises
    ------
    InputError
        If the law does not consist of polynomials, sines and constant power.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> enclosures(smoothstep(2))["D"]
    (3.464101615137754, 3.464101615137755)
    """
    with _precision:
        from optlaws.verification.exact.law import ExactLaw

        return ExactLaw(law).enclosures()


def __getattr__(name: str) -> Any:
    # a package that imports its own modules and a thread that imports one of them first would wait for each other
    if name in {"Claim", "Verification"}:
        return getattr(imported("optlaws.verification.result"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
