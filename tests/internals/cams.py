"""Internals of `optlaws.cams` that tests look at by themselves."""

from optlaws.cams import curved_limits
from optlaws.cams.as_manufactured import ArcChain, Following, PolarSpline, run_against, spline_through
from optlaws.cams.best_laws import linear_limits
from optlaws.cams.curved_limits import curvature_of
from optlaws.cams.curves import cam_files
from optlaws.cams.curves.arcs_and_chords import Arcs, arcs, polygon
from optlaws.cams.curves.cam_files import ENDINGS, FORMATS, polar, write_outline
from optlaws.cams.curves.extremes import FREE, UNDERCUT, EnclosedExtreme, enclosed_extremes
from optlaws.cams.curves.outline import Outline
from optlaws.cams.curves.plane_curve import CurveByJets, PlaneCurve
from optlaws.cams.curves.spline import Spline, even, spline, through
from optlaws.cams.followers.contact import PRESSURE
from optlaws.cams.followers.faces import FaceContact
from optlaws.cams.followers.follower import CamFollower
from optlaws.cams.followers.rollers import RollerContact, SlidingRoller, SwingingRoller
from optlaws.cams.forces import Surfaces
