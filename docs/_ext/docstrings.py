"""How docstrings and the names of the API appear on the pages."""

import re
from importlib import import_module
from itertools import pairwise

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx

import optlaws

#: what napoleon would misread, and what stands for it until the page is read: the comma between names that share a
#: description, and a colon in the first line of a property, before which it expects a type
_COMMA, _COLON = "\ue000", "\ue001"
_SHOWN = {_COMMA: ", ", _COLON: ":"}
_NAMES = re.compile(r"\w+(, \w+)+")


def prepare(_app: Sphinx, what: str, _name: str, _obj: object, _options: object, lines: list[str]) -> None:
    """Write a docstring as napoleon and docutils understand it as it is meant."""
    # |b| is a magnitude, not a substitution
    lines[:] = [re.sub(r"(?<!\\)\|", r"\\|", line) for line in lines]
    if what in {"attribute", "data", "property"} and lines:
        lines[0] = lines[0].replace(":", _COLON)
    for place, (line, following) in enumerate(pairwise(lines)):
        if _NAMES.fullmatch(line) and following.startswith(" "):
            lines[place] = line.replace(", ", _COMMA)


def finish(_app: Sphinx, doctree: nodes.document) -> None:
    """Show what `prepare` has replaced, and names of optlaws itself as they are imported."""
    for node in list(doctree.findall(nodes.Text)):
        if any(mark in node for mark in _SHOWN):
            node.parent.replace(node, nodes.Text(re.sub("|".join(_SHOWN), lambda found: _SHOWN[found[0]], node)))
    for signature in doctree.findall(addnodes.desc_signature):
        name = signature.get("fullname", "").partition(".")[0]
        for prefix in signature.findall(addnodes.desc_addname):
            if _is_a_name_of_optlaws(signature.get("module"), name):
                prefix.children = [nodes.Text("optlaws.")]


def _is_a_name_of_optlaws(module: str | None, name: str) -> bool:
    if module is None or name not in optlaws.__all__:
        return False
    return getattr(import_module(module), name, None) is getattr(optlaws, name)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the first hook before napoleon's, the other once a page is read."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-docstring", prepare, priority=100)
    app.connect("doctree-read", finish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
