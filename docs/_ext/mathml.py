"""Formulas as MathML: every browser shows it without a script, so the pages need no network."""

import re
from html import escape

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number
from sphinx.writers.html5 import HTML5Translator

logger = logging.getLogger(__name__)

#: what the converter writes, and what browsers set as print does: primes that are no letters, no gaps about bars and
#: slashes, and none between the name of a function and its bracket
_TIDY = (
    (re.compile(r"<mi>(&#x0203[2-4];)</mi>"), r'<mo lspace="0" rspace="0">\1</mo>'),
    (
        re.compile(r'<mo(?: stretchy="false")?>(&#x0007C;|&#x02016;|&#x0002F;)</mo>'),
        r'<mo stretchy="false" lspace="0" rspace="0">\1</mo>',
    ),
    (re.compile(r"<mo>([a-z]{2,6})</mo>(?=<mo[^>]*>&#x00028;)"), r'<mo lspace="0.17em" rspace="0">\1</mo>'),
)

TAG = re.compile(r"\\tag\{([^{}]*)\}")


def to_mathml(node: nodes.Element, display: str) -> str:
    """Convert a formula; a command that the converter does not know stays as it is, and is reported."""
    latex = node.astext().strip().replace("{aligned}", "{align*}")  # the name that the converter knows
    try:
        mathml = convert(latex, display=display)
    except Exception as error:  # noqa: BLE001 -- whatever the converter raises, the page is named
        logger.warning("the formula %s is not understood: %r", latex, error, location=node)
        return ""
    for written, tidy in _TIDY:
        mathml = written.sub(tidy, mathml)
    if "\\" in mathml or "<mi>&</mi>" in mathml:
        logger.warning("the formula %s holds an unknown command", latex, location=node)
    return mathml


#: where a displayed formula may go on in the next line, outside brackets and environments
_BREAK = re.compile(r"\\qquad(?![a-z])|\\allowbreak(?![a-z])")
_OPENS, _CLOSES = re.compile(r"(?<!\\)\{|\\left(?![a-z])|\\begin"), re.compile(r"(?<!\\)\}|\\right(?![a-z])|\\end")


def parts(latex: str) -> list[str]:
    r"""The parts of a displayed formula that a narrow page sets in lines of their own.

    Examples
    --------
    >>> parts(r"b = a', \qquad c = \frac{b' \qquad}{1}")
    ["b = a',", "c = \\frac{b' \\qquad}{1}"]
    """
    pieces, start = [], 0
    for place in _BREAK.finditer(latex):
        before = latex[start : place.start()]
        if len(_OPENS.findall(before)) == len(_CLOSES.findall(before)):
            pieces.append(before.strip())
            start = place.end()
    return [part for part in (*pieces, latex[start:].strip()) if part]


def visit_math(translator: HTML5Translator, node: nodes.math) -> None:
    """Write a formula in the running text."""
    translator.body.append(to_mathml(node, "inline"))
    raise nodes.SkipNode


def split_tag(latex: str) -> tuple[str, str]:
    r"""The formula without its tag, and the tag's text: a number stands apart, not in the formula.

    Examples
    --------
    >>> split_tag(r"b = a' \tag{8}")
    ("b = a' ", '8')
    """
    match = TAG.search(latex)
    return TAG.sub("", latex), match[1] if match else ""


def visit_math_block(translator: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula on a line of its own, with its number if it has one."""
    translator.body.append(translator.starttag(node, "div", CLASS="math"))
    latex, tag = split_tag(node.astext())
    if tag:
        translator.body.append(f'<span class="eqno">({escape(tag)})</span>')
    if node["number"]:
        translator.body.append(f'<span class="eqno">({get_node_equation_number(translator, node)})')
        translator.add_permalink_ref(node, "Link to this equation")
        translator.body.append("</span>")
    for part in parts(latex):
        node.children = [nodes.Text(part)]
        translator.body.append(f'<span class="part">{to_mathml(node, "block")}</span> ')
    translator.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer."""
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
