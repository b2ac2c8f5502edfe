"""Mechanisms that balance others: inertial loaders, mechanisms for links that dwell, levers with torsion bars."""

from optlaws.lazy import face

__getattr__, __dir__, __all__ = face(
    __name__,
    {
        "optlaws.balancing.dwells.choice": "DwellComparison compare_dwell_mechanisms least_dwell",
        "optlaws.balancing.dwells.clutch": "Clutch",
        "optlaws.balancing.dwells.mechanism": "DwellMechanism DwellType dwell_mechanism",
        "optlaws.balancing.dwells.sections": "Section",
        "optlaws.balancing.levers.design": "find_torsion_levers",
        "optlaws.balancing.levers.lever": "TorsionLever",
        "optlaws.balancing.levers.sizing": "LEAST_TRANSMISSION MOST_ROCKER_SWING",
        "optlaws.balancing.levers.linkage": "FourBar",
        "optlaws.balancing.levers.motion": "LeverMotion",
        "optlaws.balancing.loaders.constants": "B_loader C_loader D_loader",
        "optlaws.balancing.loaders.law": "LoaderLaw",
        "optlaws.balancing.loaders.limits": "loader_acceleration_limit loader_power_limit loader_velocity_limit",
        "optlaws.balancing.loaders.loader": "Loader inertial_loader",
        "optlaws.balancing.loaders.optimal": "BalancedLaw balanced_law",
        "optlaws.balancing.loaders.trapezium": "TrapeziumSubstitute closed_form_Y",
        "optlaws.balancing.balancing": "Balancing",
        "optlaws.balancing.dwells.dwell_machine": "DwellMachine dwell_machine",
        "optlaws.balancing.levers.lever_cam": "LeverCam rocker_law",
    },
)
