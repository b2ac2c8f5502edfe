"""What the modules of a package import, read from their syntax trees."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path


@dataclass(frozen=True)
class Import:
    """Module `source` imports module `target`; `typing` if only a type checker sees it."""

    source: str
    target: str
    line: int
    typing: bool

    def __str__(self) -> str:
        return f"{self.source}:{self.line} imports {self.target}"


#: methods that hand a value to what draws, exports, shows or proves it: the only places where such an import stands
HANDED_UP = {
    "_leaf_bound": ("optlaws.verification.",),
    "plot": ("optlaws.plots.",),
    "_plot": ("optlaws.plots.",),
    "export": ("optlaws.exports.", "optlaws.synthesis.proven.refine"),
    "report": ("optlaws.cams.report.", "optlaws.cycles.report.", "optlaws.laws.report.", "optlaws.synthesis.report."),
    "pieces": ("optlaws.exports.",),
    "polynomials": ("optlaws.exports.",),
}


def modules(package: Path) -> dict[str, Path]:
    """The package's modules by their dotted names; a package is its __init__.py."""
    found = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imports(package: Path) -> list[Import]:
    """Every import statement in the package, deferred ones included, but for those of `HANDED_UP`."""
    return _imports(package, tuple(path.stat().st_mtime_ns for path in modules(package).values()))


@cache
def _imports(package: Path, _changed: tuple[int, ...]) -> list[Import]:
    known = modules(package)
    return [found for name, path in known.items() for found in _imports_of(name, path, known)]


def _imports_of(name: str, path: Path, known: dict[str, Path]) -> Iterator[Import]:
    parent = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    for node, typing, handed_up in _statements(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(name, alias.name, node.lineno, typing)
        elif not f"{node.module}.".startswith(handed_up):
            above = parent[: len(parent) - node.level + 1] if node.level else []
            origin = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                # `from package import name` imports a module where there is one of that name.
                submodule = f"{origin}.{alias.name}"
                target = submodule if submodule in known else origin
                yield Import(name, target, node.lineno, typing)


_Statement = tuple[ast.Import | ast.ImportFrom, bool, tuple[str, ...]]


def _statements(node: ast.AST, *, typing: bool = False, handed_up: tuple[str, ...] = ()) -> Iterator[_Statement]:
    """The import statements below a node, each with whether a type checker alone sees it, and `HANDED_UP` there.

    Statements stand in statements alone: expressions are not looked through.
    """
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Import | ast.ImportFrom):
            yield child, typing, handed_up
        elif isinstance(child, ast.If):
            checked = ast.unparse(child.test).endswith("TYPE_CHECKING")
            for part in child.body:
                yield from _statements(ast.Module([part], []), typing=typing or checked, handed_up=handed_up)
            for part in child.orelse:
                yield from _statements(ast.Module([part], []), typing=typing, handed_up=handed_up)
        elif isinstance(child, ast.stmt | ast.excepthandler | ast.match_case):
            method = isinstance(node, ast.ClassDef) and isinstance(child, ast.FunctionDef)
            here = HANDED_UP.get(child.name, ()) if method and isinstance(child, ast.FunctionDef) else ()
            yield from _statements(child, typing=typing, handed_up=handed_up + here)


@cache
def declared(package: Path) -> list[tuple[str, Import]]:
    """What the tables of the package's face say in strings: a registry's subject, and its import of a module."""
    owners = {
        str(call.args[0].value): name
        for name, path in modules(package).items()
        for call in _calls(path, "Registry")
        if isinstance(call.args[0], ast.Constant)
    }
    return [
        (subject, Import(owners[subject], module, call.lineno, typing=False))
        for call in _calls(package / "__init__.py", "declare")
        for subject, table in [map(ast.literal_eval, call.args)]
        for module in table
    ]


def _calls(path: Path, function: str) -> list[ast.Call]:
    source = path.read_text("utf-8")
    nodes = ast.walk(ast.parse(source)) if function in source else ()
    return [node for node in nodes if isinstance(node, ast.Call) and ast.unparse(node.func) == function]


def cycles(found: list[Import], *, typing: bool = False) -> list[list[str]]:
    """Groups of modules that import each other, directly or not; imports for a type checker count with `typing`."""
    graph: dict[str, set[str]] = {}
    for one in found:
        if typing or not one.typing:
            graph.setdefault(one.source, set()).add(one.target)

    def reachable(start: str) -> set[str]:
        seen: set[str] = set()
        waiting = [start]
        while waiting:
            for target in graph.get(waiting.pop(), set()) - seen:
                seen.add(target)
                waiting.append(target)
        return seen

    reach = {name: reachable(name) for name in graph}
    groups = {
        tuple(sorted(other for other in reach[name] if name in reach.get(other, set())))
        for name in graph
        if name in reach[name]
    }
    return [list(group) for group in sorted(groups)]
