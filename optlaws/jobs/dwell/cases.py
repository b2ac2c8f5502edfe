"""What the job "dwell types" asks, and the mechanisms that it asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

import msgspec

from optlaws.errors import InputError
from optlaws.files import tables
from optlaws.laws.catalogue.catalogue import catalogue
from optlaws.mechanisms.angles import deg
from optlaws.mechanisms.dwell.checks import KINDS
from optlaws.mechanisms.dwell.making import dwell_mechanism
from optlaws.mechanisms.dwell.mechanism import DwellMechanism

Text = Annotated[str, msgspec.Meta(min_length=1)]
Positive = Annotated[float, msgspec.Meta(gt=0)]
Degrees = Annotated[float, msgspec.Meta(gt=0, lt=360)]
Some = msgspec.Meta(min_length=1)


class Scenario(msgspec.Struct, forbid_unknown_fields=True):
    """A name, and the angle of the rise in degrees; 180 less the dwell unless given."""

    name: Text
    rise: Degrees | None = None

    def angle(self, dwell: float) -> float:
        """The rise that goes with a dwell, in degrees."""
        return 180.0 - dwell if self.rise is None else self.rise


class Map(msgspec.Struct, forbid_unknown_fields=True):
    """Limits of b over the inertia ratio, and the range of clutch angles in degrees."""

    limits: Annotated[list[Positive], Some]
    clutch_angles: Annotated[list[Degrees], msgspec.Meta(min_length=2, max_length=2)]


class Types(msgspec.Struct, forbid_unknown_fields=True):
    """The problem file; angles in degrees."""

    job: str
    title: Text
    law: Text
    radius_over_length: Positive
    inertia_ratio: Positive
    swings: Annotated[list[Degrees], Some]
    clutch_angles: Annotated[list[Degrees], Some]
    dwells: Annotated[list[Degrees], Some]
    teeth: Annotated[int, msgspec.Meta(ge=1)]
    map: Map
    scenario: Annotated[list[Scenario], Some]

    def types(self, scenario: Scenario, swing: float, clutch_angle: float, dwell: float) -> dict[str, DwellMechanism]:
        """The types that these angles, in degrees, allow; type I is always among them."""
        found = {}
        for kind in KINDS:
            try:
                found[kind] = dwell_mechanism(
                    kind,
                    law=catalogue[self.law].law,
                    dwell=deg(dwell),
                    rise=deg(scenario.angle(dwell)),
                    clutch_angle=deg(clutch_angle),
                    swing=deg(swing),
                    radius_ratio=self.radius_over_length / deg(swing),
                    inertia_ratio=self.inertia_ratio,
                )
            except InputError:
                if kind == "I":
                    raise
        return found


@dataclass(frozen=True)
class Case:
    """One row: angles in degrees and the types that can be built."""

    scenario: str
    swing: float
    clutch_angle: float
    dwell: float
    rise: float
    types: Mapping[str, DwellMechanism]

    @property
    def given(self) -> list[tables.Cell]:
        """The first cells of a row."""
        return [self.scenario, self.swing, self.clutch_angle, self.dwell, self.rise]
