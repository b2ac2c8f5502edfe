"""The first page: its picture is what its script draws."""

from pathlib import Path
from shutil import copy

from docs.pictures.gain import draw
from tests.documents import ROOT


def test_the_picture_of_the_gain_is_current(tmp_path: Path) -> None:
    kept = Path(copy(ROOT / "docs" / "pictures" / "gain.svg", tmp_path)).read_bytes()
    vector, raster = draw(tmp_path)
    # a drawing that shows the same leaves the file as it is
    assert vector.read_bytes() == kept
    assert raster.read_bytes().startswith(b"\x89PNG")
