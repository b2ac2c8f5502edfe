"""What type checkers read of modules and packages whose names are imported when first used: the `.pyi` beside them.

`python -m tests.contracts.faces` writes them again; tests/contracts/test_faces.py holds them to the tables.
"""

import ast
from collections.abc import Iterator
from pathlib import Path

from tests.documents import ROOT


def faces() -> Iterator[tuple[Path, dict[str, str]]]:
    """Every file with a table of names, and the table."""
    for file in sorted((ROOT / "optlaws").rglob("*.py")):
        source = file.read_text("utf-8")
        for call in ast.walk(ast.parse(source)) if "face(" in source else ():
            if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) and call.func.id == "face":
                yield file, ast.literal_eval(call.args[1])


def stub(file: Path, table: dict[str, str]) -> str:
    """The names of a face as imports."""
    own = file == ROOT / "optlaws" / "__init__.py"
    lines = [f"# made by tests/contracts/faces.py from the table in {file.name}"]
    lines += [f"from optlaws import {name} as {name}" for name in ("laws", "mechanisms", "synthesis")] if own else []
    lines += [
        f"from {module} import {name} as {name}"
        for module, names in sorted(table.items())
        for name in sorted(names.split(), key=_place)
    ]
    lines += ["", "__version__: str"] if own else []
    names = sorted((name for names in table.values() for name in names.split()), key=_place)
    return "\n".join([*lines, "", "__all__ = [", *(f'    "{name}",' for name in names), "]", ""])


def _place(name: str) -> tuple[bool, str]:
    # tables, whose names are in capitals, come first
    return len(name) == 1 or not name.isupper(), name


if __name__ == "__main__":
    for path, modules in faces():
        path.with_suffix(".pyi").write_text(stub(path, modules), "utf-8")
