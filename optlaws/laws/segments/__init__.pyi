from .fractional import FractionalSegment as FractionalSegment, PowerSegment as PowerSegment
from .segment import PolynomialSegment as PolynomialSegment, Segment as Segment
from .sine import HarmonicSegment as HarmonicSegment, SineSegment as SineSegment
