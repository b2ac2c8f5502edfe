"""The first page: its picture is what its script draws."""

from pathlib import Path

from docs.pictures.gain import draw
from optlaws.files.comparison import say_the_same
from tests.documents import ROOT


def test_the_picture_of_the_gain_is_current(tmp_path: Path) -> None:
    vector, raster = draw(tmp_path)
    kept = (ROOT / "docs" / "pictures" / "gain.svg").read_bytes()
    assert say_the_same(vector.read_bytes(), kept, "svg")
    assert raster.read_bytes().startswith(b"\x89PNG")
