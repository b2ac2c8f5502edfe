"""Internals of `optlaws.cams` that tests look at by themselves."""

from optlaws.cams.as_manufactured import ArcChain, Following, PolarSpline, run_against, spline_through
from optlaws.cams.best_laws import linear_limits
from optlaws.cams.curves import cam_files
from optlaws.cams.curves.approximations import Arcs, Spline, arcs, even, polygon, spline, through
from optlaws.cams.curves.cam_files import ENDINGS, FORMATS, polar, write_outline
from optlaws.cams.curves.extremes import FREE, UNDERCUT, EnclosedExtreme, enclosed_extremes
from optlaws.cams.curves.plane_curve import Outline, PlaneCurve
from optlaws.cams.followers.contact import PRESSURE
from optlaws.cams.followers.faces import FaceContact
from optlaws.cams.followers.follower import CamFollower
from optlaws.cams.followers.rollers import RollerContact, SlidingRoller, SwingingRoller
from optlaws.cams.forces import Surfaces
from optlaws.cams.pair_forces import PairForces
from optlaws.cams.report import barrel_differences
from optlaws.cams.roller_curvature import curvature_of
