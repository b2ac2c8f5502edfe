"""Segments of piecewise laws: each kind is one class, exact as it stands."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.laws.segments.fractional": "FractionalSegment",
        "optlaws.laws.segments.segment": "PolynomialSegment PowerSegment Segment",
        "optlaws.laws.segments.sine": "HarmonicSegment SineSegment",
    },
)
