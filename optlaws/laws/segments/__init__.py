"""Segments of piecewise laws: each kind is one class with exact closed forms."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.laws.segments.fractional": "FractionalSegment",
        "optlaws.laws.segments.constant_power": "PowerSegment",
        "optlaws.laws.segments.segment": "PolynomialSegment Segment",
        "optlaws.laws.segments.sine": "HarmonicSegment SineSegment",
    },
)
