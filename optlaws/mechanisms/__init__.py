"""What laws do in machines: elastic followers and the cams made for them."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.numbers": "deg",
        "optlaws.mechanisms.follower.response": "CycleResponse Response",
        "optlaws.mechanisms.follower.follower": "Deviation Follower off_design",
        "optlaws.mechanisms.drives.drive_train": "Drive",
        "optlaws.mechanisms.drives.motor": "Motor read_motors",
        "optlaws.mechanisms.linkages.bodies": "Body Loads",
        "optlaws.mechanisms.linkages.mechanism": "Mechanism",
        "optlaws.mechanisms.linkages.four_bar": "four_bar",
        "optlaws.mechanisms.linkages.motions": "belt mechanism_of_motion rack screw",
        "optlaws.mechanisms.linkages.slider_crank": "slider_crank",
        "optlaws.mechanisms.linkages.toggle": "toggle",
        "optlaws.mechanisms.machine.machine": "Machine",
        "optlaws.mechanisms.machine.masses": "Link",
        "optlaws.mechanisms.follower.polydyne": "mass_law polydyne",
        "optlaws.mechanisms.spectrum.residual": "residual_functional residual_phasor",
        "optlaws.mechanisms.spectrum.spectrum": "ResponseSpectrum response_spectrum",
    },
)
