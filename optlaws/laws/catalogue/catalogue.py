"""The catalogue of standard laws, read from catalogue.toml when it is first used."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from optlaws.echo import shortened
from optlaws.errors import InputError
from optlaws.kept import kept_property

if TYPE_CHECKING:
    from optlaws.laws.catalogue.entry import CatalogueEntry

#: the law that cams and servo axes have where nothing else is said
USUAL = "modified sine"
ALIKE = 0.6  # a likeness of names below it is chance

_LONGEST = 200


class UnknownLaw(InputError, KeyError):  # noqa: N818 - named like the other errors of optlaws
    """The catalogue has no law of this name; the message names those that are nearest.

    Examples
    --------
    >>> catalogue["modified sin"]
    Traceback (most recent call last):
    optlaws.laws.catalogue.catalogue.UnknownLaw: no law is called 'modified sin'; did you mean 'modified sine'...
    """

    def __str__(self) -> str:
        return str(self.args[0])


class Catalogue(Mapping[str, "CatalogueEntry"]):
    """Standard motion laws by name: textbook laws, controllers' enumerations, Tyr's coded laws.

    A name may be any alias in the data, in English, German or of a controller; capitals, blanks and punctuation do not
    count. Codes mmnn(p) and KCmm that are not listed are laws as well. Iteration gives the names listed.

    Examples
    --------
    >>> catalogue["modified sine"].law
    PiecewiseLaw(segments=4, B=1.7596, C=5.52796, D=5.45775, J=69.4664)
    >>> catalogue["MODSINUSLINIE"] is catalogue["Modified Sine"], "0412(1,5)" in catalogue
    (True, True)
    >>> [entry.name for entry in catalogue.search("trapez")][:2]
    ['trapezoid with thirds', 'trapezoidal velocity in thirds']
    """

    @kept_property
    def _entries(self) -> dict[str, CatalogueEntry]:
        import tomllib

        from optlaws.laws.catalogue.entry import CatalogueEntry

        text = Path(__file__).with_name("catalogue.toml").read_text(encoding="utf-8")
        return {entry["name"]: CatalogueEntry.of_table(entry) for entry in tomllib.loads(text)["law"]}

    @kept_property
    def _by_alias(self) -> dict[str, CatalogueEntry]:
        from optlaws.laws.catalogue.entry import canonical

        entries = self._entries.values()
        return {canonical(name) or plain(name): entry for entry in entries for name in (*entry.aliases, entry.name)}

    def __getitem__(self, name: str) -> CatalogueEntry:
        from optlaws.laws.catalogue.entry import canonical

        if not isinstance(name, str):
            raise UnknownLaw(f"the name of a law is text, got {shortened(name)}")
        if len(name) > _LONGEST:
            raise UnknownLaw(f"no law is called {shortened(name)}; `optlaws catalogue` lists them")
        code = canonical(name)
        named = self._by_alias.get(code or plain(name))
        if named is not None:
            return named
        if code is not None:
            return self._coded(code)
        near = [f"{entry.name!r}" for entry in self.search(name)[:3]]
        hint = f"did you mean {' or '.join(near)}?" if near else "`optlaws catalogue` lists them"
        raise UnknownLaw(f"no law is called {name!r}; {hint}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __repr__(self) -> str:
        return f"<catalogue of {len(self)} laws: {', '.join(list(self)[:3])}, ...>"

    def _repr_html_(self) -> str:
        from optlaws.laws.report import law_panels
        from optlaws.shown.report import panel_drawing
        from optlaws.shown.showing import Html, page, table

        rows = []
        for name, entry in self._entries.items():
            peaks = (row.value for row in entry.constants.summary()[:-1])
            rows.append([name, *peaks, Html(*map(panel_drawing, law_panels(entry.law, "c")))])
        return page(f"{len(self)} standard laws", table(("law", "B", "C", "D", "J", "acceleration"), rows))

    def search(self, text: str) -> tuple[CatalogueEntry, ...]:
        """The entries that a text may mean, the likeliest first: by name, part of a name, words, likeness.

        Parameters
        ----------
        text
            A name in any language, part of one, or words of a source.

        Examples
        --------
        >>> [entry.name for entry in catalogue.search("BESTEHORN")]
        ['cycloidal']
        """
        ranked = [(_rank(entry, text), entry) for entry in self._entries.values()]
        near = sorted(((rank, entry) for rank, entry in ranked if rank is not None), key=lambda pair: pair[0])
        good = [entry for rank, entry in near if rank < 4.0]
        return tuple(good or [entry for _, entry in near])

    def _coded(self, code: str) -> CatalogueEntry:
        from optlaws.laws.catalogue.entry import CatalogueEntry

        entry = CatalogueEntry(
            code, (), ("code", code), "by the rule of Tyr's coded laws", from_memory=False, published=()
        )
        try:
            _ = entry.law
        except InputError as error:
            raise UnknownLaw(str(error)) from None
        return entry


def plain(name: str) -> str:
    """A name without capitals, blanks and punctuation.

    Examples
    --------
    >>> plain("Modified-Sine CV 20%")
    'modifiedsinecv20'
    """
    return re.sub(r"[\W_]+", "", name.casefold())


def _rank(entry: CatalogueEntry, text: str) -> float | None:
    """The distance of an entry from a text: None where it is too large."""
    from difflib import SequenceMatcher

    words = plain(text)
    names = [plain(name) for name in (entry.name, *entry.aliases)]
    if not words:
        return None
    if words in names:
        return 0.0
    for rank, fits in ((1.0, str.startswith), (2.0, str.__contains__)):
        if any(fits(name, words) for name in names):
            return rank + len(entry.name) / 1000.0
    everything = plain(" ".join((entry.name, *entry.aliases, entry.source)))
    if all(plain(word) in everything for word in text.split()):
        return 3.0
    likeness = max(SequenceMatcher(None, words, name).ratio() for name in names)
    return 5.0 - likeness if likeness >= ALIKE else None


catalogue = Catalogue()
