"""The notebooks run from top to bottom, and are kept without outputs."""

from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

from tests.documents import ROOT

NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


def test_there_are_three_without_outputs() -> None:
    assert len(NOTEBOOKS) == 3
    for file in NOTEBOOKS:
        notebook = nbformat.read(file, as_version=4)
        nbformat.validate(notebook)
        code = [cell for cell in notebook.cells if cell.cell_type == "code"]
        assert not any(cell.outputs or cell.execution_count for cell in code), f"{file.name}: strip its outputs"


@pytest.mark.filterwarnings("default")  # of the kernel's own packages
def test_notebooks_run_and_show_what_they_made(tmp_path: Path) -> None:
    notebooks = {file.name: nbformat.read(file, as_version=4) for file in NOTEBOOKS}
    client = NotebookClient(nbformat.v4.new_notebook(), timeout=120, resources={"metadata": {"path": str(tmp_path)}})
    # one kernel, which forgets each notebook before the next
    with client.setup_kernel():
        for name, notebook in notebooks.items():
            notebook.cells.insert(0, nbformat.v4.new_code_cell("%reset -f"))
            client.nb = notebook
            for i, cell in enumerate(notebook.cells):
                client.execute_cell(cell, i)
            shown = [output for cell in notebook.cells for output in cell.get("outputs", ())]
            assert any("text/html" in output.get("data", {}) for output in shown), name
            wrong = [one for one in shown if one.output_type == "error" or one.get("name") == "stderr"]
            assert not wrong, f"{name}: {wrong}"
