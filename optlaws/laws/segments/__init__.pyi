from .constant_power import PowerSegment as PowerSegment
from .fractional import FractionalSegment as FractionalSegment
from .segment import PolynomialSegment as PolynomialSegment, Segment as Segment
from .sine import HarmonicSegment as HarmonicSegment, SineSegment as SineSegment
