"""Tables of many columns on narrow pages: each row as a block whose cells name their columns (see pages.css)."""

from docutils import nodes
from sphinx.application import Sphinx

#: columns from which on a table is wider than a phone
_MANY = 4


def label_cells(_app: Sphinx, doctree: nodes.document) -> None:
    """Give the cells of wide tables the headings of their columns, which only narrow pages show."""
    for table in doctree.findall(nodes.table):
        headings = [entry for head in table.findall(nodes.thead) for entry in head.findall(nodes.entry)]
        if len(headings) < _MANY:
            continue
        table["classes"].append("stacked")
        for row in (row for body in table.findall(nodes.tbody) for row in body.findall(nodes.row)):
            for heading, cell in list(zip(headings, row.children, strict=False))[1:]:
                _label(heading, cell)


def _label(heading: nodes.Node, cell: nodes.Node) -> None:
    first, text = next(cell.findall(nodes.paragraph), None), next(heading.findall(nodes.paragraph), None)
    if first is not None and text is not None and first.astext().strip():
        words = [child.deepcopy() for child in text.children]
        first.insert(0, nodes.inline("", "", *words, nodes.Text(": "), classes=["column"]))


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the hook once a page is read."""
    app.connect("doctree-read", label_cells)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
