"""The numbers that starters of problem files take: the kinds of files that each is of, and what it may be."""

from __future__ import annotations

from math import inf

from optlaws.entries.value_types import Choice, InSI, Measured, Number, ValueType, Whole

_STROKE, _DURATION = Measured("length", "angle", above=0.0), Measured("angle", "time", above=0.0)
_LENGTH, _SIDE = Measured("length", above=0.0), InSI("length", above=0.0)
_MASS = Measured("mass", "moment of inertia", above=0.0)
DERIVATIVES = ("velocity", "acceleration", "jerk")
_VELOCITY, _ACCELERATION, _JERK = (Measured(name, f"angular {name}", above=0.0) for name in DERIVATIVES)
_INERTIA, _TORQUE = InSI("moment of inertia", least=0.0), InSI("torque", above=0.0, absent=inf)
_UNTIL = "an angle of the master or a time."
_LEAST = "unless given the least one that keeps pressure angle and radius of curvature."
#: by the kinds of their files what numbers may be, what they are unless given, and what they say; None leaves one out
_TABLES: dict[str, dict[str, tuple[ValueType, str | None, str]]] = {
    "cycle, cam, barrel, drive, fastest, interlock, machine, law": {
        "stroke": (_STROKE, "35 mm", "How far it moves: a length or an angle, of cams a length, of a drive an angle."),
    },
    "cycle, cam, barrel, interlock": {
        "rise": (_DURATION, "120 deg", f"How long the rise takes: {_UNTIL}"),
        "dwell": (_DURATION, "90 deg", f"How long it dwells behind the rise: {_UNTIL}"),
        "return": (_DURATION, "100 deg", f"How long the return takes: {_UNTIL}"),
        "speed": (Measured("angular velocity", above=0.0), "200 rpm", "Speed of the master."),
    },
    "cycle, cam, mechanism": {
        "mass": (
            _MASS,
            None,
            "Mass, or moment of inertia, that moves, of a mechanism its slide: force and power are then shown.",
        ),
    },
    "cycle, cam, fastest, law": {
        "velocity": (
            _VELOCITY,
            None,
            "Greatest velocity; unless given of a cam that of modified sine, of a least time an example, else none.",
        ),
        "acceleration": (
            _ACCELERATION,
            None,
            "Greatest acceleration; unless given of a cam with a mass that of modified sine, else as the velocity.",
        ),
    },
    "cycle, cam, barrel, drive, mechanism, fastest, law": {
        "jerk": (_JERK, None, "Greatest jerk; unless given that of modified sine, of a least time an example."),
    },
    "cam, barrel": {
        "roller": (_LENGTH, "12 mm", "Radius of the roller."),
        "pressure-angle": (Measured("angle"), "30 deg", "Greatest pressure angle; of a barrel none unless given."),
    },
    "barrel": {
        "outer-radius": (_LENGTH, "80 mm", "Radius of the cylinder."),
        "depth": (_LENGTH, "12 mm", "Depth of the groove."),
        "cutter": (_LENGTH, None, "Radius of the cutter."),
    },
    "cam": {
        "offset": (Measured("length"), None, "Offset of the follower's line from the shaft; 0 unless given."),
        "curvature": (Measured("length", least=0.0), "5 mm", "Least radius of curvature."),
        "prime-radius": (_LENGTH, None, f"Prime radius; {_LEAST}"),
    },
    "drive, mechanism, machine, law": {
        "duration": (Measured("time", above=0.0), "0.1 s", "How long the move takes."),
    },
    "drive, mechanism": {"period": (Measured("time", above=0.0), "0.6 s", "Time of the whole cycle.")},
    "drive": {
        "inertia": (_INERTIA, "0.8 kg m^2", "Moment of inertia of the table that is turned."),
        "friction": (Measured("torque", least=0.0), None, "Friction at the table; none unless given."),
        "ratio": (Number(above=0.0), "20", "Turns of the motor with a turn of the table."),
        "efficiency": (
            Number(above=0.0, most=1.0),
            None,
            "Efficiency of the gear, up to 1, in both directions; 1 unless given.",
        ),
        "rotor": (_INERTIA, "3e-4 kg m^2", "Moment of inertia of the motor."),
        "rated-torque": (_TORQUE, "2 N m", "Continuous (rated) torque of the motor."),
        "peak-torque": (_TORQUE, "6 N m", "Torque that the motor must not exceed."),
        "greatest-speed": (InSI("angular velocity", above=0.0, absent=inf), "3000 rpm", "Greatest speed of the motor."),
    },
    "mechanism": {
        "crank": (_SIDE, "100 mm", "Length of the crank."),
        "rod": (_SIDE, "400 mm", "Length of the rod."),
        "flywheel": (_INERTIA, "0.5 kg m^2", "Moment of inertia at the crank."),
        "load": (Measured("force", above=0.0), "600 N", "Force of the process against the slide."),
    },
    "interlock": {
        "index": (_STROKE, "45 deg", "How far the table moves while the slide is out of its way."),
        "clear": (_STROKE, "20 mm", "Position from which on the slide is clear of the table."),
        "within": (_STROKE, "0.5 deg", "How far from its stations the table counts as arrived."),
    },
    "fastest, machine": {
        "frequency": (Measured("frequency", above=0.0), "8.5 Hz", "Natural frequency of the elastic load."),
        "damping": (Number(least=0.0), "0.02", "Damping ratio of the load."),
    },
    "machine": {
        "spread": (Number(least=0.0, most=1.0), "0.1", "Relative deviation of the frequency: 0.1 for 10 %."),
        "sway": (_STROKE, "1 mm", "How far the load may sway afterwards."),
    },
    "law, study": {
        "minimise": (Choice("C", "D", "J", "rms_c", "rms_j"), "C", "Constant that is least: C, D, J, rms_c or rms_j."),
    },
    "law": {"order": (Whole(1), "3", "Number of boundary conditions at each end.")},
    "study": {
        "degree": (Whole(1), "9", "Degree of Z(k)."),
        "from": (Number(above=1.0), "1.5", "Least peak velocity B, above 1."),
        "to": (Number(above=1.0), "2", "Greatest peak velocity B."),
        "steps": (Whole(1), "11", "How many values of B."),
    },
}
#: and what they are of the files of some kinds
_USUAL: dict[str, dict[str, str | None]] = {
    "barrel": {"roller": "8 mm", "pressure-angle": None},
    "drive": {"stroke": "45 deg", "duration": "0.25 s"},
    "mechanism": {"mass": "12 kg", "duration": "0.5 s", "period": "0.7 s"},
    "fastest": {"stroke": "300 mm", "frequency": "13 Hz"},
    "interlock": {"stroke": "50 mm", "rise": "60 deg", "dwell": "120 deg", "return": "60 deg", "speed": "60 rpm"},
    "machine": {"stroke": "300 mm", "duration": "0.4 s"},
}
TYPES = {name: number[0] for table in _TABLES.values() for name, number in table.items()}
#: by their names the kinds that have them, and what they say
ABOUT = {name: (kinds, number[2]) for kinds, table in _TABLES.items() for name, number in table.items()}


def numbers_of(kind: str) -> dict[str, str | None]:
    """The numbers of a kind of file by their names, as they are unless given.

    >>> numbers_of("study")
    {'minimise': 'C', 'degree': '9', 'from': '1.5', 'to': '2', 'steps': '11'}
    """
    tables = (table for kinds, table in _TABLES.items() if kind in kinds.split(", "))
    return {name: usual for table in tables for name, (_, usual, _) in table.items()} | _USUAL.get(kind, {})
