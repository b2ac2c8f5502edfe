"""The numbers that starters of problem files take: the kinds of files that each is of, and what it says."""

from __future__ import annotations

#: by the kinds of their files
NUMBERS: dict[str, dict[str, str]] = {
    "cycle, cam, machine, law": {"stroke": "How far it moves: a length or an angle, of a cam a length."},
    "cycle, cam": {
        "rise": "How long the rise takes: an angle of the master or a time.",
        "dwell": "How long it dwells behind the rise: an angle of the master or a time.",
        "return": "How long the return takes: an angle of the master or a time.",
        "speed": "Speed of the master.",
        "mass": "Mass, or moment of inertia, that is moved: table and picture then show force and power.",
    },
    "cycle, cam, law": {
        "velocity": "Greatest velocity; none unless given.",
        "acceleration": "Greatest acceleration; none unless given.",
        "jerk": "Greatest jerk; that of modified sine unless given.",
    },
    "cam": {
        "roller": "Radius of the roller.",
        "offset": "Offset of the follower's line from the shaft; 0 unless given.",
        "pressure-angle": "Greatest pressure angle.",
        "curvature": "Least radius of curvature.",
        "prime-radius": "Prime radius; unless given the least one that keeps pressure angle and radius of curvature.",
    },
    "machine, law": {"duration": "How long the move takes."},
    "machine": {
        "frequency": "Natural frequency of the elastic load.",
        "damping": "Damping ratio of the load.",
        "spread": "How far the frequency may be off, as a share of it.",
        "sway": "How far the load may sway afterwards.",
    },
    "law, study": {"minimise": "Constant that is least: C, D, J, rms_c or rms_j."},
    "law": {"order": "Number of boundary conditions at each end."},
    "study": {
        "degree": "Degree of Z(k).",
        "from": "Least peak velocity B, above 1.",
        "to": "Greatest peak velocity B.",
        "steps": "How many values of B.",
    },
}


def numbers_of(kind: str) -> list[str]:
    """The names of the numbers of a kind of file.

    >>> numbers_of("study")
    ['minimise', 'degree', 'from', 'to', 'steps']
    """
    return [name for kinds, numbers in NUMBERS.items() if kind in kinds.split(", ") for name in numbers]
