"""How docstrings and the names of the API appear on the pages."""

import re
from importlib import import_module
from inspect import isclass
from itertools import pairwise

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx

#: what napoleon would misread, and what stands for it until the page is read: the comma between names that share a
#: description, and a colon in the first line of a property, before which it expects a type; both of full width, and
#: punctuation to docutils
_COMMA, _COLON = "\uff0c", "\uff1a"
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


def prepare_signature(
    _app: Sphinx, _what: str, _name: str, _obj: object, _options: object, signature: str | None, returned: str | None
) -> tuple[str | None, str | None]:
    """Write a signature so that it can be read as Python: what a factory makes is no expression."""
    return signature and signature.replace("<factory>", "..."), returned


def finish(_app: Sphinx, doctree: nodes.document) -> None:
    """Show what `prepare` has replaced, and names as they are imported."""
    for node in list(doctree.findall(nodes.Text)):
        if any(mark in node for mark in _SHOWN):
            node.parent.replace(node, nodes.Text(re.sub("|".join(_SHOWN), lambda found: _SHOWN[found[0]], node)))
    for signature in doctree.findall(addnodes.desc_signature):
        module, name = signature.get("module"), signature.get("fullname", "").partition(".")[0]
        for prefix in signature.findall(addnodes.desc_addname):
            if module is not None and not prefix.astext().startswith(name):
                prefix.children = [nodes.Text(_shown_module(module, name))]
    for kind in doctree.findall(addnodes.literal_emphasis):
        for node in list(kind.findall(nodes.Text)):
            node.parent.replace(node, nodes.Text(_MODULE.sub("", node)))


#: the modules of types, where a description names one in full
_MODULE = re.compile(r"^(?:~?(?:optlaws|collections|numpy|fractions|typing|pathlib|matplotlib)\.)(?:\w+\.)*(?=\w+$)")


def _shown_module(module: str, name: str) -> str:
    """What stands before a name: where it is imported from, and nothing before a class that functions return."""
    rooms = module.split(".")
    value = getattr(import_module(module), name, None)
    for depth in range(1, len(rooms)):
        public = ".".join(rooms[:depth])
        if value is not None and getattr(import_module(public), name, None) is value:
            return f"{public}."
    return "" if isclass(value) and len(rooms) > _PUBLIC else f"{module}."


#: names of a module within so many are public: optlaws.results, optlaws.errors
_PUBLIC = 2


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the first hook before napoleon's, the other once a page is read."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-docstring", prepare, priority=100)
    app.connect("autodoc-process-signature", prepare_signature)
    app.connect("doctree-read", finish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
