"""The modules whose mutants are tried, each with the tests that speak of it; its own doctests run too."""

BOUNDS = (
    "tests/synthesis/proof/test_duality.py",
    "tests/synthesis/proof/test_certificate_by_hand.py",
    "tests/synthesis/proof/test_certificate.py",
)
LAWS = ("tests/contracts/test_laws.py", "tests/laws/test_exactness.py")
SEGMENTS = ("tests/contracts/test_segments.py", *LAWS)
NUMERICS = ("tests/numerics", *LAWS)

TESTS: dict[str, tuple[str, ...]] = {
    "optlaws.synthesis.program.writer": ("tests/synthesis/program/test_evaluation.py",),
    "optlaws.numerics.peaks": ("tests/numerics/test_peaks.py", "tests/laws/test_exactness.py"),
    "optlaws.synthesis.proof.certificate": (*BOUNDS, "tests/synthesis/proof/test_peaks.py"),
    "optlaws.synthesis.proof.duality": BOUNDS,
    "optlaws.synthesis.proof.power.box": (
        "tests/synthesis/proof/power/test_certificate_by_hand.py",
        "tests/synthesis/proof/power/test_certificate.py",
        "tests/synthesis/proof/power/test_boxes.py::test_no_law_in_a_box_breaks_a_row",
    ),
    "optlaws.verification.exact.bound": (
        "tests/verification/exact/test_bound_by_hand.py",
        "tests/verification/test_verify.py",
        "tests/verification/test_kinds.py",
    ),
    "optlaws.numerics.chebyshev": NUMERICS,
    "optlaws.numerics.exact": ("tests/laws/test_polynomial.py", *LAWS),
    "optlaws.numerics.roots": ("tests/numerics", "tests/laws/test_savin.py"),
    "optlaws.numerics.panels": NUMERICS,
    "optlaws.laws.curve": LAWS,
    "optlaws.laws.law": ("tests/laws/segments/test_piecewise.py", *LAWS),
    "optlaws.laws.polynomial": ("tests/laws/test_polynomial.py", *LAWS),
    "optlaws.laws.segments.piecewise": ("tests/laws/segments/test_piecewise.py", *LAWS),
    "optlaws.laws.segments.segment": ("tests/laws/segments/test_piecewise.py", *SEGMENTS),
    "optlaws.laws.segments.sine": ("tests/laws/segments", "tests/laws/making/test_trapezoids.py", *SEGMENTS),
    "optlaws.laws.segments.fractional": ("tests/laws/segments", *SEGMENTS),
    "optlaws.laws.making.multiplier": ("tests/laws/making/test_multiplier.py",),
    "optlaws.laws.making.transform": ("tests/laws/making/test_transform.py", "tests/contracts/test_segments.py"),
    "optlaws.laws.making.trapezoids": ("tests/laws/making/test_trapezoids.py", "tests/laws/catalogue", *LAWS),
    "optlaws.laws.savin": ("tests/laws/test_savin.py",),
    "optlaws.laws.catalogue.entry": ("tests/laws/catalogue",),
    "optlaws.formulas.slopes": ("tests/formulas/test_values.py",),
    "optlaws.shown.showing": ("tests/test_showing.py",),
    "optlaws.shown.steps": ("tests/test_showing.py",),
    "optlaws.verification.result": ("tests/verification/test_reading.py", "tests/verification/test_verify.py"),
    "optlaws.verification.machines.transfer": ("tests/verification/machines",),
    "optlaws.synthesis.spaces.space": ("tests/synthesis/spaces", "tests/contracts/test_families.py"),
    "optlaws.cycles.optimisation.optimal": (
        "tests/cycles/optimisation/test_optimal.py",
        "tests/cycles/optimisation/test_joined.py",
        "tests/cycles/optimisation/test_shared_limits.py",
    ),
    "optlaws.cycles.optimisation.shared_limits": ("tests/cycles/optimisation/test_shared_limits.py",),
}
