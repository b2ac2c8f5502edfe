"""How the force between cam and follower acts: its lever on the follower, how the surfaces slide, what guides bear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from optlaws.series.enclosures.jets import Jet


class Drag(NamedTuple):
    """What a friction force of 1 N along the surfaces does to the follower, the way in which the cam's runs past.

    Attributes
    ----------
    lever
        It drives the follower with so many N, or N m.
    across
        Its sideways part on a slide, and 0 on an arm, N.
    moment
        About where the force meets a slide's way, N m.
    """

    lever: Jet
    across: Jet | float = 0.0
    moment: Jet | float = 0.0


class Transmission(NamedTuple):
    """What a force of 1 N between cam and follower does, at places of the turn or in intervals of them.

    Attributes
    ----------
    lever
        On the follower: 1 N along the normal drives it with so many N, or N m.
    sliding
        How fast the surfaces slide, or the roller rolls, m per radian of the cam.
    across
        Sideways part of the normal's force on a slide, and 0 on an arm, N.
    moment
        Of the normal's force about where a slide's way meets the level of the contact, N m.
    drag
        What friction along the surfaces does; None of a roller, which gives way.
    """

    lever: Jet
    sliding: Jet
    across: Jet
    moment: Jet
    drag: Drag | None = None

    def lever_with(self, friction: float) -> Jet:
        """What drives the follower for a normal force of 1 N, friction of the surfaces included."""
        return self.lever if self.drag is None else self.lever + self.drag.lever * friction


@dataclass(frozen=True)
class Friction:
    """Friction of a cam and its follower; coefficients without a dimension, lengths in metres.

    Attributes
    ----------
    contact
        Of a face that slides on the cam; of a roller, what rolling and its pin take, at the roller's surface.
    guide
        Of a slide in its guide.
    overhang, length
        From where the cam touches to the guide, and the guide's length.
    """

    contact: float = 0.0
    guide: float = 0.0
    overhang: float = 0.0
    length: float = 1.0

    def in_guide(self, transmission: Transmission) -> Jet:
        """Friction in the guide, of either sign of the velocity, for a normal force of 1 N."""
        drag = transmission.drag
        across = transmission.across + (0.0 if drag is None else drag.across * self.contact)
        moment = transmission.moment
        if drag is not None and isinstance(drag.moment, Jet):
            moment = moment + drag.moment * self.contact
        near = moment + across * (self.overhang + self.length)
        far = moment + across * self.overhang
        return (near.magnitude() + far.magnitude()) * (self.guide / self.length)
