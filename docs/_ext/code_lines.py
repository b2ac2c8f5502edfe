"""Lines of code as elements of their own, so that a narrow page can set in what is continued."""

from collections.abc import Iterable, Iterator

from pygments.formatters import HtmlFormatter
from sphinx.application import Sphinx
from sphinx.highlighting import PygmentsBridge


class LineFormatter(HtmlFormatter):
    """Pygments' formatter with a span around each line."""

    def wrap(self, source: Iterable[tuple[int, str]]) -> Iterator[tuple[int, str]]:
        """The lines, between the tags around all of them."""
        for is_line, text in super().wrap(source):
            line = text.removesuffix("\n")
            yield is_line, f'<span class="line">{line}</span>\n' if is_line else text


def setup(_app: Sphinx) -> dict[str, bool]:
    """Use the formatter for all code."""
    PygmentsBridge.html_formatter = LineFormatter
    return {"parallel_read_safe": True, "parallel_write_safe": True}
