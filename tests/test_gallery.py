"""The gallery: twenty pictures and more, each with about ten lines; they are run when the pages are made."""

import ast
from pathlib import Path

import pytest

from tests.documents import ROOT

EXAMPLES = sorted((ROOT / "docs" / "examples").glob("*.py"))


def test_there_are_twenty_and_more() -> None:
    assert len(EXAMPLES) >= 20


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda file: file.stem)
def test_an_example_has_a_title_a_sentence_and_few_lines(example: Path) -> None:
    text = example.read_text("utf-8")
    tree = ast.parse(text)
    title, underline, _, *body = (ast.get_docstring(tree) or "").splitlines()
    assert underline == "=" * len(title)
    assert body[0].endswith(".")
    code = text.split('"""')[2]
    assert len([line for line in code.splitlines() if line.strip()]) <= 18
    assert {
        node.module.partition(".")[0] for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node.module
    } <= {"optlaws", "matplotlib", "dataclasses"}
