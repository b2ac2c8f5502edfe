"""References to where an object is defined lead to where it is documented.

`MotionLaw` lives in a module of its own and is documented as a name of the package that re-exports it;
annotations name the module.
"""

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.util.nodes import make_refnode


def resolve(
    app: Sphinx, env: BuildEnvironment, node: pending_xref, content: nodes.TextElement
) -> nodes.reference | None:
    """Find the documented object that is the one referred to: the same name, in a package above it."""
    target: str = node.get("reftarget", "")
    if node.get("refdomain") != "py" or not target.startswith("optlaws."):
        return None
    objects = env.domains.python_domain.objects
    *package, name = target.split(".")
    while package:
        documented = objects.get(".".join([*package, name]))
        if documented is not None:
            source: str = node.get("refdoc", env.docname)
            return make_refnode(app.builder, source, documented.docname, documented.node_id, content)
        package.pop()
    # a name that a package above re-exports from the room of another subject
    same = [entry for path, entry in objects.items() if path.rpartition(".")[2] == name and path.startswith("optlaws.")]
    if len(same) == 1:
        source = node.get("refdoc", env.docname)
        return make_refnode(app.builder, source, same[0].docname, same[0].node_id, content)
    return None


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the resolver."""
    app.connect("missing-reference", resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
