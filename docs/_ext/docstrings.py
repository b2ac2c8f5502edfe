"""How docstrings and the names of the API appear on the pages."""

import ast
import re
from importlib import import_module
from inspect import isclass
from itertools import pairwise

from docutils import nodes
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

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
    """Write a signature so that it can be read as Python; what cannot be is at least without the modules of types."""
    if signature is None:
        return None, returned
    # what a factory makes, a member of an enumeration, an object, and a parameter of types are no expressions
    written = re.sub(r"<\w+\.\w+: ('\w*')>", r"\1", signature.replace("<factory>", "...").replace(".~", "."))
    written = re.sub(r"<[\w.]+ object(?: at \w+)?>", "...", written)
    written = re.sub(r"(?:\w+\.)*Annotated\[((?:~?\w+\.)*\w+), [^\]]*\]", r"\1", written)
    try:
        ast.parse(f"def function{written.replace('~', '')}: ...")
    except SyntaxError:
        written = re.sub(r"~(?:\w+\.)*~?", "", written)
    return written, returned


def finish(_app: Sphinx, doctree: nodes.document) -> None:
    """Show what `prepare` has replaced, and names as they are imported."""
    for node in list(doctree.findall(nodes.Text)):
        if any(mark in node for mark in _SHOWN):
            node.parent.replace(node, nodes.Text(re.sub("|".join(_SHOWN), lambda match: _SHOWN[match[0]], node)))
    for signature in doctree.findall(addnodes.desc_signature):
        module, name = signature.get("module"), signature.get("fullname", "")
        if module is not None and name and "." not in name:
            _show_module(signature, _shown_module(module, name))
    for kind in doctree.findall(addnodes.literal_emphasis):
        for node in list(kind.findall(nodes.Text)):
            node.parent.replace(node, nodes.Text(_MODULE.sub("", node)))


def _show_module(signature: addnodes.desc_signature, module: str) -> None:
    """Name the module of a name: before it, or, as it may be long, on the line below unless it is optlaws itself."""
    if module == "optlaws.":
        (place,) = [signature.index(child) for child in signature.children if isinstance(child, addnodes.desc_name)]
        signature.insert(place, addnodes.desc_addname("", module))
    elif module and isinstance(signature.parent, addnodes.desc):
        line = nodes.paragraph("", "", nodes.Text("from "), nodes.literal("", module.rstrip(".")))
        next(signature.parent.findall(addnodes.desc_content)).insert(0, line)


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


def skip(_app: Sphinx, what: str, name: str, _obj: object, skipped: bool, options: object) -> bool | None:  # noqa: FBT001 - as Sphinx calls it
    """Leave out what a list of members does not name: inherited members of classes bring all of a module else."""
    listed = getattr(options, "members", None)
    return True if what == "module" and isinstance(listed, list) and name not in listed else skipped or None


class IndexedNames(SphinxTransform):
    """Entries of the index with the modules from which names are imported, before the index takes them."""

    default_priority = 800

    def apply(self, **_options: object) -> None:
        """Write the entries of a page."""
        for node in self.document.findall(addnodes.index):
            node["entries"] = [(kind, _in_index(text), *others) for kind, text, *others in node["entries"]]


#: how an entry of the index ends that names a module
_IN_MODULE = re.compile(r"(?P<name>\w+)(?P<call>\(\))? \((?P<what>class )?in (?:module )?(?P<module>optlaws[\w.]*)\)")


def _in_index(text: str) -> str:
    """An entry of the index with the module from which its name is imported, or with none."""
    match = _IN_MODULE.fullmatch(text)
    if match is None:
        return text
    module = _shown_module(match["module"], match["name"]).rstrip(".")
    what = ("class in " if match["what"] else "in ") + module if module else "class"
    return f"{match['name']}{match['call'] or ''} ({what})"


#: names of a module within so many are public: optlaws.results, optlaws.errors
_PUBLIC = 2


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the first hook before napoleon's, the other once a page is read."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-docstring", prepare, priority=100)
    app.connect("autodoc-skip-member", skip)
    app.connect("autodoc-process-signature", prepare_signature)
    app.add_transform(IndexedNames)
    app.connect("doctree-read", finish)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
