"""Internals of `optlaws.motion` that tests look at by themselves."""

from optlaws.motion.motion import Motion, Units, motion_of_law
from optlaws.motion.piece import Piece
from optlaws.motion.quantities import DIMENSIONS, TURN, either, quantity, written
from optlaws.motion.smooth_parts import SmoothParts
