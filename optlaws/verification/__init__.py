"""Proofs checked with every rounding enclosed, without a solver: what a file claims, and what of it is proven.

It needs python-flint (``pip install "optlaws[verify]"``), which is imported at the first use.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from optlaws.errors import InputError
from optlaws.laws import MotionLaw
from optlaws.synthesis.certificate import Certificate
from optlaws.verification.result import Claim, Verification

__all__ = ["Claim", "Verification", "enclosures", "exact_bound", "verify"]


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
        If it is neither, its laws are not polynomials, or python-flint is missing.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Chebyshev(9)))
    >>> found = verify(solution.to_dict())
    >>> found.proven, round(found.bound, 9), abs(found.gap) < 1e-12
    (True, 4.647776025, True)
    """
    _need_flint()
    from optlaws.verification import checks

    return checks.verify(source)


def exact_bound(certificate: Certificate) -> Fraction | None:
    """The lower bound that a certificate proves, rounded down; None if it proves nothing.

    Of a proof that no law exists, it is by how much the constraints contradict each other: above 0 if it stands.

    Raises
    ------
    InputError
        If the problem's laws are not polynomials, or python-flint is missing.

    Examples
    --------
    >>> import optlaws
    >>> solution = optlaws.synthesize(optlaws.Problem(B=1.859, order=4, basis=optlaws.Chebyshev(9)))
    >>> abs(float(exact_bound(solution.certificate)) - solution.certificate.bound) < 1e-9
    True
    """
    _need_flint()
    from optlaws.verification import bound

    return bound.prove(certificate).value


def enclosures(law: MotionLaw) -> dict[str, tuple[float, float]]:
    """Floats below and above B, C, D, J and rms_c of the very polynomial a law's numbers describe.

    Raises
    ------
    InputError
        If the law is not a polynomial, or python-flint is missing.

    Examples
    --------
    >>> from optlaws import smoothstep
    >>> enclosures(smoothstep(2))["D"]
    (3.464101615137754, 3.464101615137755)
    """
    _need_flint()
    from optlaws.verification import exact_law

    return exact_law.enclosures(law)


def _need_flint() -> None:
    if find_spec("flint") is None:
        raise InputError('exact verification needs python-flint: pip install "optlaws[verify]"')
