"""The notebooks: they run from top to bottom, and what is committed shows their results."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

NOTEBOOKS = sorted((Path(__file__).parents[2] / "notebooks").glob("*.ipynb"))
assert NOTEBOOKS, "there must be notebooks to test"
MACHINE_PATH = re.compile(
    r"(?<![\w.:/])/(home|Users|root|tmp|var|private|opt|usr|work)/|\b[A-Z]:\\\\\w"
)
LARGEST = 1_000_000  # bytes

pytestmark = pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)


def read(path):
    return nbformat.read(path, as_version=4)


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def outputs(notebook, kind):
    every = [output for cell in code_cells(notebook) for output in cell.outputs]
    return [output for output in every if output.output_type == kind]


def without_pictures(notebook):
    """The notebook as text; base64 may spell anything."""
    for output in outputs(notebook, "display_data") + outputs(notebook, "execute_result"):
        output.data.pop("image/png", None)
    return nbformat.writes(notebook)


def test_runs_at_small_size(path, tmp_path, monkeypatch):
    """Beside the folders that belong to the notebooks, in which it leaves nothing."""
    monkeypatch.setenv("GIMPSLOPE_CELL", "0.5")
    for folder in path.parent.iterdir():
        if folder.is_dir():
            shutil.copytree(folder, tmp_path / folder.name)
    before = sorted(tmp_path.rglob("*"))
    notebook = read(path)
    resources = {"metadata": {"path": str(tmp_path)}}
    client = NotebookClient(notebook, timeout=120, kernel_name="python3", resources=resources)
    client.execute()
    assert outputs(notebook, "error") == []
    assert [output.text for output in outputs(notebook, "stream") if output.name == "stderr"] == []
    assert sorted(tmp_path.rglob("*")) == before


def test_committed_outputs_are_of_one_run_from_top_to_bottom(path):
    cells = code_cells(read(path))
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))


def test_committed_outputs_show_pictures_and_no_errors(path):
    notebook = read(path)
    pictures = [o for o in outputs(notebook, "display_data") if "image/png" in o.data]
    assert pictures
    assert outputs(notebook, "error") == []
    assert {output.name for output in outputs(notebook, "stream")} == {"stdout"}


def test_committed_file_is_small_and_of_no_machine(path):
    assert path.stat().st_size < LARGEST
    notebook = read(path)
    assert MACHINE_PATH.search(without_pictures(notebook)) is None
    assert notebook.metadata.kernelspec.name == "python3"
    assert all("execution" not in cell.metadata for cell in notebook.cells)
