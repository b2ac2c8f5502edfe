"""Internals of `optlaws.laws` that tests look at by themselves."""

from optlaws.laws.catalogue.catalogue import plain
from optlaws.laws.catalogue.entry import canonical, coded, continuity_with_rest
from optlaws.laws.curve import Curve
from optlaws.laws.law import direction_of
from optlaws.laws.making.input_shaping import Shaper
from optlaws.laws.making.through_points import law_of_table
from optlaws.laws.making.transform import as_polynomial, law_between, section
from optlaws.laws.making.trapezoids import from_half
from optlaws.laws.report import law_panels, table_of_values
from optlaws.laws.savin import alpha_range
from optlaws.laws.segments.fractional import FractionalSegment, PowerSegment, PowerSum
from optlaws.laws.segments.segment import PolynomialSegment, Segment
from optlaws.laws.segments.sine import HarmonicSegment, SineSegment
