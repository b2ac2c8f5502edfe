"""Internals of `optlaws.mechanisms` that tests look at by themselves."""

from optlaws.mechanisms.drives.peak_torque import least_peak_torque
from optlaws.mechanisms.linkages.mechanism_kinds import MechanismKind
from optlaws.mechanisms.linkages.move_limit import move_limit
from optlaws.mechanisms.linkages.plane_linkages import SliderCrank
from optlaws.mechanisms.machine.machine import Measure
from optlaws.mechanisms.machine.output_constants import OutputConstant, OutputPeak, output_peak, output_rms
from optlaws.mechanisms.machine.polydyne import CamPeak, CamPower, cam_factors, cam_powers, gain
from optlaws.mechanisms.machine.residual import BandResidual, ModeResidual
from optlaws.mechanisms.machine.response import MassMotion, Oscillator
from optlaws.mechanisms.machine.spectrum import above
from optlaws.mechanisms.machine.state_space import StateSpace
from optlaws.mechanisms.machine.transforms import moments
