"""The first page: its picture is what its script draws."""

import re
from pathlib import Path

from docs.pictures.gain import draw
from tests.documents import ROOT

NUMBER = re.compile(r'(?<=[ "])-?\d+\.\d+')


def test_the_picture_of_the_gain_is_current(tmp_path: Path) -> None:
    stored = (ROOT / "docs" / "pictures" / "gain.svg").read_text("utf-8").splitlines()
    vector = draw(tmp_path)
    lines = [line for line in zip(vector.read_text("utf-8").splitlines(), stored, strict=True) if line[0] != line[1]]
    for line, other in lines:
        # how far along its flat top a peak is marked, out of 660, is decided by rounding
        assert "made by optlaws" in line or "<use " in line
        if "<use " in line:
            assert NUMBER.sub("", line) == NUMBER.sub("", other)
            (x, y), (other_x, other_y) = (map(float, NUMBER.findall(text)) for text in (line, other))
            assert abs(x - other_x) < 4.0
            assert abs(y - other_y) < 0.05
