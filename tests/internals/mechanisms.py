"""Internals of `optlaws.mechanisms` that tests look at by themselves."""

from optlaws.mechanisms.follower.cam_constants import CamPeak, CamPower, gain
from optlaws.mechanisms.follower.polydyne import cam_factors, cam_powers
from optlaws.mechanisms.follower.response import MassMotion
from optlaws.mechanisms.follower.vibration import Oscillator
from optlaws.mechanisms.machine.output_constants import OutputConstant, OutputPeak, output_peak, output_rms
from optlaws.mechanisms.machine.residual_boxes import ModeResidual
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.mechanisms.spectrum.residual import Residual
from optlaws.mechanisms.spectrum.transforms import legendre_from_chebyshev, moments
