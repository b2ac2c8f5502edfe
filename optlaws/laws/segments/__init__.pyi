# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.laws.segments.constant_power import PowerSegment as PowerSegment
from optlaws.laws.segments.fractional import FractionalSegment as FractionalSegment
from optlaws.laws.segments.segment import PolynomialSegment as PolynomialSegment
from optlaws.laws.segments.segment import Segment as Segment
from optlaws.laws.segments.sine import HarmonicSegment as HarmonicSegment
from optlaws.laws.segments.sine import SineSegment as SineSegment

__all__ = [
    "FractionalSegment",
    "HarmonicSegment",
    "PolynomialSegment",
    "PowerSegment",
    "Segment",
    "SineSegment",
]
