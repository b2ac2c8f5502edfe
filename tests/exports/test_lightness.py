"""How much of optlaws an export loads, and how many calls a cycle with its table takes."""

import subprocess
import sys

import pytest

from optlaws import Cycle, Dwell, Return, Rise

MODULES, CALLS = 80, 8000


def table_of_cycle(law: str, angle: str) -> str:
    segments = [Rise("35 mm", angle, law=law), Dwell("90 deg"), Return("35 mm", "100 deg", law=law), Dwell()]
    text: str = Cycle(segments, speed="200 rpm").export("csv", points=361).text
    return text


def test_an_export_of_a_law_loads_little_of_the_library() -> None:
    script = (
        "import sys, optlaws\n"
        "optlaws.smoothstep(3).export('csv', stroke='35 mm', duration='0.1 s', points=21).text\n"
        "print(*(name for name in sys.modules if name.partition('.')[0] == 'optlaws'))"
    )
    run = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    loaded = run.stdout.split()
    assert len(loaded) < MODULES
    above = ("optlaws.cycles", "optlaws.synthesis.", "optlaws.mechanisms.", "optlaws.formulas")
    assert [name for name in loaded if name.startswith(above)] == []


@pytest.mark.parametrize("law", ["cycloidal", "modified sine", "polynomial 3-4-5", "cubic"])
def test_a_cycle_with_its_table_takes_few_calls(law: str) -> None:
    calls = 0

    def count(_frame: object, event: str, _argument: object) -> None:
        nonlocal calls
        calls += event == "call"

    table_of_cycle(law, "120 deg")  # modules are imported, units and the law are read
    before = sys.getprofile()
    sys.setprofile(count)
    try:
        text = table_of_cycle(law, "110 deg")
    finally:
        sys.setprofile(before)
    assert len(text.splitlines()) == 363
    assert calls < CALLS
