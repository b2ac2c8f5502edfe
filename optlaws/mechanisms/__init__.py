"""What laws do in machines: elastic followers and the cams made for them."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.mechanisms.angles": "deg",
        "optlaws.mechanisms.follower.cycle": "CycleResponse",
        "optlaws.mechanisms.follower.follower": "Follower",
        "optlaws.mechanisms.follower.off_design": "Deviation off_design",
        "optlaws.mechanisms.follower.response": "Response",
        "optlaws.mechanisms.machine.machine": "Machine",
        "optlaws.mechanisms.machine.masses": "Link",
        "optlaws.mechanisms.cam.polydyne": "mass_law polydyne",
        "optlaws.mechanisms.spectrum.residual": "residual_functional residual_phasor",
        "optlaws.mechanisms.spectrum.spectrum": "ResponseSpectrum response_spectrum",
    },
)
