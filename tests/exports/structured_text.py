"""A reader of the Structured Text that is written here: blark parses it, and a few lines turn it into Python."""

import re
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

KINDS: dict[str, Callable[[Any], Any]] = {
    "LREAL": np.float64,
    "REAL": np.float32,
    "DINT": int,
    "INT": int,
    "BOOL": bool,
}
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "LIMIT": lambda low, value, high: min(max(value, low), high),
    "MIN": min,
    "MAX": max,
    "ABS": abs,
    "SQRT": np.sqrt,
    "EXP": np.exp,
    "LN": np.log,
}


def parsed(source: str) -> Any:
    """What blark makes of a source; it raises where the grammar of IEC 61131-3 does not allow it."""
    from blark.parse import parse_source_code  # type: ignore[import-untyped] # ships no types

    result = parse_source_code(source)
    if result.exception is not None:
        raise result.exception
    return result.transform()


def without_comments(source: str) -> str:
    return re.sub(r"\(\*.*?\*\)", "", source, flags=re.DOTALL)


class Block:
    """A function block: call it with x, or with inputs by their names, and read its outputs."""

    def __init__(self, source: str) -> None:
        text = without_comments(source)
        self.name = re.search(r"FUNCTION_BLOCK (\w+)", text)[1]  # type: ignore[index]
        self.kinds: dict[str, str] = {}
        self.values: dict[str, Any] = {}
        declarations = re.findall(r"\bVAR\w*(?: CONSTANT)?\n(.*?)END_VAR", text, re.DOTALL)
        for name, kind, first in re.findall(r"(\w+) : ([^;:]+?)(?: := ([^;]*))?;", "".join(declarations)):
            self._declare(name, kind, first)
        body = text[text.rindex("END_VAR") + len("END_VAR") : text.index("END_FUNCTION_BLOCK")]
        self.code = compile(_python(body, self.kinds), self.name, "exec")

    def __call__(self, x: float | None = None, **inputs: Any) -> dict[str, Any]:
        for name, value in (inputs if x is None else {"x": x}).items():
            self.values[name] = KINDS[self.kinds[name]](value)
        exec(self.code, dict(FUNCTIONS), self.values)  # noqa: S102 - a few lines that were written here
        return self.values

    def _declare(self, name: str, kind: str, first: str) -> None:
        array = re.fullmatch(r"ARRAY\[0\.\.(\d+)\] OF (\w+)", kind)
        if array is None:
            self.kinds[name] = kind
            self.values[name] = KINDS[kind](first or 0)
            return
        numbers = [KINDS[array[2]](one) for one in first.strip("[] \n").split(",")]
        assert len(numbers) == int(array[1]) + 1
        self.values[name] = numbers


@cache
def _rules() -> list[tuple[re.Pattern[str], str]]:
    return [
        (re.compile(pattern), made)
        for pattern, made in (
            (r"^FOR (\w+) := (.+) TO (.+) BY -1 DO$", r"for \1 in range(\2, \3 - 1, -1):"),
            (r"^WHILE (.+) DO$", r"while \1:"),
            (r"^IF (.+) THEN$", r"if \1:"),
            (r"^ELSIF (.+) THEN$", r"elif \1:"),
            (r"^ELSE$", r"else:"),
            (r"^(\w+) := (.+);$", r"\1 = \2"),
        )
    ]


def _python(body: str, kinds: dict[str, str]) -> str:
    """The statements as Python."""
    lines, depth = [], 0
    for line in filter(None, map(str.strip, body.splitlines())):
        if line in {"END_FOR;", "END_WHILE;", "END_IF;"}:
            depth -= 1
            continue
        depth -= line.startswith(("ELSE", "ELSIF"))
        made = line.replace(" AND ", " and ").replace(" OR ", " or ").replace(" <> ", " != ").replace(" = ", " == ")
        if kinds.get(line.split(" := ")[0]) == "DINT":
            made = made.replace(" / ", " // ")
        for pattern, replacement in _rules():
            made = pattern.sub(replacement, made)
        lines.append("    " * depth + made)
        depth += made.endswith(":")
    return "\n".join(lines)
