"""Motion laws: their definitions, their values and their peaks. Imports no optimiser."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.laws.constants": "Constants",
        "optlaws.laws.law": "MotionLaw",
        "optlaws.laws.making.trapezoids": "from_half",
        "optlaws.laws.polynomial": "PolynomialLaw smoothstep",
        "optlaws.numerics.peaks": "Peak",
    },
)
