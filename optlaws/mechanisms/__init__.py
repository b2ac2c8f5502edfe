"""Laws in machines: elastic followers, their response spectra and cams; linear machines."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.numbers": "deg",
        "optlaws.mechanisms.machine.response": "CycleResponse Response",
        "optlaws.mechanisms.machine.follower": "Deviation Follower off_design",
        "optlaws.mechanisms.drives.drive_train": "Drive",
        "optlaws.mechanisms.drives.motor": "Motor read_motors",
        "optlaws.mechanisms.linkages.bodies": "Body Loads",
        "optlaws.mechanisms.linkages.mechanism": "Mechanism",
        "optlaws.mechanisms.linkages.four_bar": "four_bar",
        "optlaws.mechanisms.linkages.motions": "belt mechanism_of_motion rack screw",
        "optlaws.mechanisms.linkages.move_limit": "MoveLimit",
        "optlaws.mechanisms.linkages.slider_crank": "slider_crank",
        "optlaws.mechanisms.linkages.toggle": "toggle",
        "optlaws.mechanisms.machine.machine": "Machine",
        "optlaws.mechanisms.machine.masses": "Link",
        "optlaws.mechanisms.polydyne_cam": "mass_law polydyne",
        "optlaws.mechanisms.residual": "residual_functional residual_phasor",
        "optlaws.mechanisms.spectrum": "ResponseSpectrum response_spectrum",
    },
)
