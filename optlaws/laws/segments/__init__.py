"""Segments of piecewise laws: each kind is one class, exact as it stands."""

from optlaws.laws.segments.fractional import FractionalSegment
from optlaws.laws.segments.segment import PolynomialSegment, PowerSegment, Segment
from optlaws.laws.segments.sine import HarmonicSegment, SineSegment

__all__ = ["FractionalSegment", "HarmonicSegment", "PolynomialSegment", "PowerSegment", "Segment", "SineSegment"]
