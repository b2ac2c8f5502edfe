"""Pages of results in Markdown: a title, and what is said, shown and tabled below it."""

from __future__ import annotations

from collections.abc import Sequence

from optlaws.files import tables, writing


class Page:
    """A page that is written from its top to its end.

    Examples
    --------
    >>> print(Page("Laws").text("Two of them.").table(["law", "C"], [["K", 4.93], ["Co", 6.28]]), end="")
    # Laws
    <BLANKLINE>
    <!-- made by optlaws -->
    <BLANKLINE>
    Two of them.
    <BLANKLINE>
    | law | C    |
    |-----|------|
    | K   | 4.93 |
    | Co  | 6.28 |
    """

    def __init__(self, title: str) -> None:
        self._parts = [f"# {title}\n", f"<!-- {writing.MARK} -->\n"]

    def heading(self, text: str) -> Page:
        """A heading below the title."""
        return self._add(f"## {text}")

    def text(self, text: str) -> Page:
        """A paragraph or several; none if the text is blank."""
        return self._add(text.strip()) if text.strip() else self

    def figure(self, name: str, caption: str) -> Page:
        """The picture `name`.svg beside the page."""
        return self._add(f"![{caption}]({name}.svg)")

    def table(self, headings: Sequence[str], rows: Sequence[Sequence[tables.Cell]], *, digits: int = 7) -> Page:
        """A table with aligned columns, its numbers to so many digits."""
        self._parts.append(tables.to_markdown(headings, rows, digits=digits))
        return self

    def _add(self, line: str) -> Page:
        self._parts.append(f"{line}\n")
        return self

    def __str__(self) -> str:
        return "\n".join(self._parts)
