"""An entry of the catalogue: a law with its names, source and published constants, and the laws that codes stand for.

The codes are those of Tyr's catalogue: mmnn(p), straight ramp, plateau and a fall like x^p, and KCmm, ramp and cosine.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import pi
from typing import Any, Self

import numpy as np

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.files.reading import JsonText, entries_of
from optlaws.kept import kept_property
from optlaws.laws.law import HIGHEST, Constants, MotionLaw
from optlaws.laws.making.trapezoids import from_half, scca, trapezoid
from optlaws.laws.polynomial import smoothstep
from optlaws.laws.segments.piecewise import PiecewiseLaw
from optlaws.laws.segments.segment import Segment
from optlaws.laws.segments.sine import HarmonicSegment, SineSegment
from optlaws.shown.report import PlainReport, Report, report_page
from optlaws.shown.summary import Row, Summary
from optlaws.tolerances import JUMP

_TRAPEZOID = re.compile(r"(\d\d)(\d\d)(?:\((\d+(?:[.,]\d+)?)\))?")
_COSINE = re.compile(r"KC(\d\d)", re.IGNORECASE)


def canonical(text: str) -> str | None:
    """A code as printed, with a decimal comma and without an exponent of 1; None where a text is no code.

    Examples
    --------
    >>> canonical("0317 (1.50)"), canonical("0510(1)"), canonical("kc05"), canonical("K")
    ('0317(1,5)', '0510', 'KC05', None)
    """
    plain = text.replace(" ", "")
    if match := _TRAPEZOID.fullmatch(plain):
        power = float((match[3] or "1").replace(",", "."))
        return match[1] + match[2] + ("" if power == 1.0 else f"({power:.15g})".replace(".", ","))
    return plain.upper() if _COSINE.fullmatch(plain) else None


def coded(code: str) -> PiecewiseLaw:
    """The law of a code.

    `mmnn(p)`: c rises straight for mm hundredths of the motion, is constant for nn and falls to zero at k = 1/2 like
    x^p, x the time to it (p = 1 without brackets; decimal comma or point). `KCmm`: c rises along a quarter sine for mm
    hundredths and falls along a raised cosine. c is odd about k = 1/2.

    Parameters
    ----------
    code
        The code, for example "0510", "0317(1,5)" or "KC05".

    Raises
    ------
    InputError
        If it is no code, ramp and plateau exceed half the motion, or p is zero.

    Examples
    --------
    >>> coded("0510")
    PiecewiseLaw(segments=6, B=1.62162, C=5.40541, D=4.41741, J=108.108)
    >>> coded("KC00").constants.B
    Peak(value=1.423199, k=0.5)
    """
    plain = code.replace(" ", "")
    if match := _TRAPEZOID.fullmatch(plain):
        ramp, plateau = int(match[1]), int(match[2])
        _check_room(code, ramp + plateau)
        return trapezoid(ramp / 100, plateau / 100, exponent=float((match[3] or "1").replace(",", ".")))
    if match := _COSINE.fullmatch(plain):
        _check_room(code, int(match[1]))
        return _cosine(int(match[1]) / 100)
    raise InputError(f"a law code is mmnn, mmnn(p) or KCmm, for example 0317(1,5) or KC05; got {shortened(code)}")


def _check_room(code: str, hundredths: int) -> None:
    if hundredths > 50:
        raise InputError(f"code {code!r}: the accelerating half has 50 hundredths of the motion, not {hundredths}")


def _cosine(ramp: float) -> PiecewiseLaw:
    fall = 0.5 - ramp
    pieces: list[tuple[float, Segment]] = []
    if ramp:
        pieces.append((ramp, SineSegment(1.0, 0.5 * pi / ramp)))
    if fall:
        pieces.append((fall, SineSegment(0.5, pi / fall, 0.5 * pi, powers=(0.5,))))
    return from_half(pieces)


#: half segments, which end or begin at their greatest velocity: acceleration in words, and exactly
_HALVES = {
    "C1": ("c = π sin πk", SineSegment(pi, pi)),
    "C2": ("c = -π sin πk, b(0) = 2", SineSegment(-pi, pi, b0=2.0)),
    "H1": ("c = π²/4 cos πk/2", SineSegment(0.25 * pi * pi, 0.5 * pi, 0.5 * pi)),
    "H2": ("c = -π²/4 sin πk/2, b(0) = π/2", SineSegment(-0.25 * pi * pi, 0.5 * pi, b0=0.5 * pi)),
}
_LETTERS = ("a", "b", "c", "j", "j'", "j''")
BUILDERS = ("smoothstep", "sines", "cosines", "half", "scca", "trapezoid", "code")


@dataclass(frozen=True)
class Published:
    """Constants as printed in a publication, and whether they agree with the law to the printed digits.

    Examples
    --------
    >>> Published(by="a table", printed=(("C", "4.89"),)).disagreements(smoothstep(2).constants)
    ('C = 4.89 is 6',)
    """

    by: str
    printed: tuple[tuple[str, str], ...]

    def disagreements(self, constants: Constants) -> tuple[str, ...]:
        """The printed values that differ from the constants rounded to the printed digits."""
        different = []
        for name, text in self.printed:
            value = getattr(constants, name).value
            digits = len(text.partition(".")[2])
            if abs(value - float(text)) > 0.5 * 10.0**-digits * (1.0 + 1e-9):
                different.append(f"{name} = {text} is {value:.7g}")
        return tuple(different)


@dataclass(frozen=True)
class CatalogueEntry(JsonText):
    """A law of the catalogue.

    Attributes
    ----------
    name
        What the catalogue calls it.
    names
        Other names, by language or controller.
    definition
        How it is built: the name of a construction and its numbers, fractions as text.
    source
        Where the definition comes from.
    from_memory
        Whether the definition was written down from memory and not compared with its source.
    published
        Constants printed elsewhere.

    Examples
    --------
    >>> from optlaws import catalogue
    >>> entry = catalogue["BESTEHORN"]
    >>> entry.name, entry.continuity, entry.constants.B.value
    ('cycloidal', 2, 2.0)
    """

    _json_name = "an entry of the catalogue"

    name: str
    names: tuple[tuple[str, tuple[str, ...]], ...]
    definition: tuple[str, Any]
    source: str
    from_memory: bool
    published: tuple[Published, ...]

    @classmethod
    def of_table(cls, data: Mapping[str, Any]) -> CatalogueEntry:
        """The entry of a table of the catalogue's data file."""
        (builder,) = (key for key in BUILDERS if key in data)
        numbers = data[builder]
        if isinstance(numbers, list | dict):
            numbers = tuple(numbers.items() if isinstance(numbers, dict) else numbers)
        return cls(
            name=data["name"],
            names=tuple((language, tuple(some)) for language, some in data.get("names", {}).items()),
            definition=(builder, numbers),
            source=data["source"],
            from_memory=data.get("from_memory", False),
            published=tuple(map(_published, data.get("published", ()))),
        )

    def __repr__(self) -> str:
        return f"CatalogueEntry({self.name!r}, {self.formula!r})"

    def report(self) -> Report:
        """Its names, how it is built, its source and its constants, with the curves of its law."""
        also = "; ".join(f"{language}: {', '.join(some)}" for language, some in self.names)
        rows = [Row("law", self.name), Row("also", also), Row("built", self.formula), Row("source", self.source)]
        rows += [Row("", "the definition is from memory: compare it with the source")] if self.from_memory else []
        facts = Summary([*rows, continuity_row(self.continuity), *self.constants.summary()], at="k")
        return PlainReport(facts, (), self.law.report().panels, self.to_dict)

    def _repr_html_(self) -> str:
        return report_page(self.name, self.report())

    @property
    def aliases(self) -> tuple[str, ...]:
        """The other names of the law, without the numbers of enumerations."""
        return tuple(name.partition(" = ")[0] for _, some in self.names for name in some)

    @kept_property
    def law(self) -> MotionLaw:
        """The law, from exact segments."""
        return _built(*self.definition)

    @property
    def constants(self) -> Constants:
        """B, C, D, J and the RMS of c, within the motion: a jump of c at its ends counts in `continuity` alone."""
        return self.law.constants

    @kept_property
    def continuity(self) -> int:
        """The highest order whose derivative, and all below, are continuous with rest before and after the motion.

        0 is a, 1 is b, 2 is c, 3 is j; c that is not continuous is a jerk without bound.
        """
        return continuity_with_rest(self.law)

    @property
    def formula(self) -> str:
        """How the law is built, in a few words."""
        builder, numbers = self.definition
        if builder in ("sines", "cosines"):
            wave, base, outer = ("sin", 2, "2π") if builder == "sines" else ("cos", 1, "π²")
            terms = " + ".join(f"{q} {wave} {base * int(n)}πk" for n, q in numbers)
            return f"c = {outer} ({terms})".replace("+ -", "- ").replace("(1 ", "(").replace(" 1πk", " πk")
        if builder == "code":
            return f"code {numbers}"
        if builder == "half":
            return _HALVES[numbers][0]
        return f"{builder}({numbers if builder == 'smoothstep' else ', '.join(numbers)})"

    def to_dict(self) -> dict[str, Any]:
        """The entry as plain data.

        Examples
        --------
        >>> from optlaws import catalogue
        >>> sorted(catalogue["cubic"].to_dict())
        ['aliases', 'constants', 'continuity', 'definition', 'formula', 'from_memory', 'law', 'name', 'published', ...]
        """
        return {
            "name": self.name,
            "aliases": {language: list(some) for language, some in self.names},
            "definition": list(self.definition),
            "formula": self.formula,
            "source": self.source,
            "from_memory": self.from_memory,
            "continuity": self.continuity,
            "constants": self.constants.to_dict(),
            "published": [{"by": source.by, **dict(source.printed)} for source in self.published],
            "law": self.law.to_dict(),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """The entry that `to_dict` described, by its definition; law and constants are computed.

        Raises
        ------
        InputError
            If an entry is missing or wrong.
        """
        keys = ("name", "aliases", "definition", "source", "from_memory", "published")
        name, aliases, definition, source, from_memory, published = entries_of(data, keys, cls._json_name).values()
        try:
            printed = tuple(map(_published, published))
            names = tuple((language, tuple(some)) for language, some in aliases.items())
            read = cls(name, names, _in_tuples(definition), source, from_memory, printed)
            read.law  # noqa: B018 - what is wrong is refused at once
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
            raise InputError(f"this is not {cls._json_name}: {error}") from None
        return read


def _published(row: Mapping[str, Any]) -> Published:
    return Published(row["by"], tuple((name, text) for name, text in row.items() if name != "by"))


def _in_tuples(value: Any) -> Any:
    return tuple(map(_in_tuples, value)) if isinstance(value, list | tuple) else value


def continuity_row(order: int) -> Row:
    """Which derivatives of a law are continuous, in letters."""
    return Row("continuous", ", ".join(_LETTERS[: order + 1]))


def continuity_with_rest(law: MotionLaw) -> int:
    """The highest order whose derivative, and all below, are continuous with rest before and after the motion.

    Examples
    --------
    >>> continuity_with_rest(smoothstep(3)), smoothstep(3).continuity
    (2, 9)
    """
    inside = law.continuity
    start, end = law.boundary_values(HIGHEST + 1)
    for nu in range(1, inside + 1):
        height = max(abs(start[nu]), abs(end[nu]))
        if height and height > JUMP * float(np.abs(law(np.linspace(0.0, 1.0, 65), nu)).max()):
            return nu - 1
    return inside


def _built(builder: str, numbers: Any) -> MotionLaw:
    if builder == "smoothstep":
        return smoothstep(numbers)
    if builder == "code":
        return coded(numbers)
    if builder == "half":
        return PiecewiseLaw([0.0, 1.0], [_HALVES[numbers][1]])
    if builder in ("scca", "trapezoid"):
        build = scca if builder == "scca" else trapezoid
        return build(*(float(Fraction(number)) for number in numbers))
    terms = [(int(n), float(Fraction(q))) for n, q in numbers]
    scale, base, phase = (2.0 * pi, 2.0 * pi, 0.0) if builder == "sines" else (pi * pi, pi, 0.5 * pi)
    amplitudes = tuple(scale * q for _, q in terms)
    frequencies = tuple(base * n for n, _ in terms)
    phases = tuple(phase for _ in terms)
    if len(terms) == 1:
        wave: Segment = SineSegment(amplitudes[0], frequencies[0], phase)
    else:
        wave = HarmonicSegment(amplitudes, frequencies, phases)
    return PiecewiseLaw([0.0, 1.0], [wave])
