"""The job "follower": cams for an elastic follower, at and off their design, tabled and drawn (Savin's Fig. 4)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from optlaws.errors import InputError
from optlaws.files import writing
from optlaws.files.problem_file import convert
from optlaws.jobs.follower import figure, tables
from optlaws.laws import MotionLaw
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.laws.savin.family import FAMILIES
from optlaws.laws.savin.savin import savin
from optlaws.mechanisms.polydyne.polydyne import polydyne
from optlaws.studies.points.problem_entries import Positive, Text
from optlaws.suggest import unknown_key

Ratio = Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]
Vibrating = Annotated[float, msgspec.Meta(ge=0.0, lt=1.0)]
Percent = Annotated[float, msgspec.Meta(gt=-100.0, le=1000.0)]
Some = msgspec.Meta(min_length=1)


class AskedCam(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A cam: the law meant for the mass, and the damping ratio for which (1.27) corrects it, if it does."""

    name: Text
    law: Text
    alpha: float | None = None
    design_damping: Ratio | None = None


class Run(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """A cam on followers whose nu deviates."""

    cam: Text
    damping: Ratio
    change: Literal["speed", "stiffness"] = "speed"


class SpectrumPicture(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The figure of the response spectra."""

    cams: Annotated[list[Text], Some]
    damping: Vibrating
    least: Positive = msgspec.field(name="from")
    most: Positive = msgspec.field(name="to")
    points: Annotated[int, msgspec.Meta(ge=2, le=100_000)] = 1000


class CurvePicture(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The figure of accelerations over time: cam, mass as designed, mass off its design."""

    cams: Annotated[list[Text], msgspec.Meta(min_length=1, max_length=4)]
    damping: Ratio
    deviations: Annotated[list[Percent], msgspec.Meta(min_length=1, max_length=3)]
    until: Annotated[float, msgspec.Meta(ge=1.0, le=10.0)] = 1.5


class Study(msgspec.Struct, kw_only=True, forbid_unknown_fields=True):
    """The problem file."""

    job: str
    title: Text
    nu: Positive
    deviations: Annotated[list[Percent], Some]
    cam: Annotated[list[AskedCam], Some]
    off_design: Annotated[list[Run], Some]
    spectrum: SpectrumPicture
    curves: CurvePicture
    text: str = ""


@dataclass(frozen=True)
class Cam:
    """A cam of the study.

    Parameters
    ----------
    name
        What the file calls it.
    reference
        The law meant for the mass.
    design_damping
        Damping ratio for which it is corrected, None if it is not.
    law
        What is cut.
    """

    name: str
    reference: MotionLaw
    design_damping: float | None
    law: MotionLaw


def run(data: Mapping[str, Any], file: Path, out: Path) -> list[Path]:
    """Do the job and return the files written."""
    spec = convert(data, Study, file)
    cams = {one.name: _cam(one, spec.nu) for one in spec.cam}
    if len(cams) != len(spec.cam):
        raise InputError("cam: names must differ")
    for name in [*(one.cam for one in spec.off_design), *spec.spectrum.cams, *spec.curves.cams]:
        if name not in cams:
            raise InputError(unknown_key(name, cams, "cam"))
    if spec.spectrum.least >= spec.spectrum.most:
        raise InputError(f"spectrum: from must be below to, got {spec.spectrum.least:g} and {spec.spectrum.most:g}")
    about = f"{spec.title}; from {file.name}"
    written = [writing.write(out / name, text) for name, text in tables.texts(spec, cams, about).items()]
    drawings = {
        "spectrum": figure.spectrum(spec, [cams[name] for name in spec.spectrum.cams]),
        "curves": figure.curves(spec, [cams[name] for name in spec.curves.cams]),
    }
    for name, kinds in drawings.items():
        written += [writing.write(out / f"{name}.{kind}", content) for kind, content in kinds.items()]
    return written


def _cam(asked: AskedCam, nu: float) -> Cam:
    try:
        reference = _law(asked)
        cut = reference if asked.design_damping is None else polydyne(reference, nu, asked.design_damping)
    except InputError as error:
        raise InputError(f"cam {asked.name}: {error}") from None
    return Cam(asked.name, reference, asked.design_damping, cut)


def _law(asked: AskedCam) -> MotionLaw:
    if (asked.law in FAMILIES) != (asked.alpha is not None):
        raise InputError(f"the laws {', '.join(FAMILIES)} need an alpha, and no other takes one")
    return catalogue[asked.law].law if asked.alpha is None else savin(asked.law, asked.alpha)
