"""A hundred thousand points pass through without being kept."""

import subprocess
import sys
from pathlib import Path

import pytest

from optlaws import open_study
from tests.documents import ROOT

pytestmark = pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="memory is read from Linux's /proc")

# in a process of its own: pytest's would be measured too
SCRIPT = """
import os, sys
from pathlib import Path
from optlaws import run_study

PAGE = os.sysconf("SC_PAGE_SIZE") / 2**20

def megabytes(pid):
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * PAGE
    except OSError:
        return 0.0

class Memory:
    def __init__(self):
        self.seen = []
    def begin(self, total, counts):
        self.total = total
    def advance(self, counts):
        solvers = [int(pid) for one in Path("/proc/self/task").glob("*/children") for pid in one.read_text().split()]
        most = max(map(megabytes, solvers), default=0)
        self.seen.append((sum(counts.values()) / self.total, megabytes("self"), most))
    def end(self, counts):
        pass

memory = Memory()
steps, out = int(sys.argv[1]), sys.argv[2]
asked = {"problem": {"order": 2, "degree": 1}, "vary": {"B": {"from": 1.5, "to": 1.6, "steps": steps}}}
study = run_study(asked, out, workers=2, watch=memory)
early = [one for one in memory.seen if 0.1 <= one[0] <= 0.2]
late = [one for one in memory.seen if one[0] >= 0.9]
at_the_end = megabytes("self")
for place in (1, 2):
    print(max(one[place] for one in early), max(one[place] for one in late))
print(max(one[1] for one in early), at_the_end)
"""


@pytest.mark.long
def test_a_hundred_thousand_points_take_no_memory(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, "100000", str(tmp_path / "out")],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
    )
    growth = [float(late) - float(early) for early, late in (line.split() for line in done.stdout.splitlines())]
    # the run, its solver processes, and the run after the table was written, for which pyarrow was loaded, some 75 MB
    assert growth[0] < 15.0, done.stdout
    assert growth[1] < 15.0, done.stdout
    assert growth[2] < 100.0, done.stdout
    study = open_study(tmp_path / "out")
    assert study.counts == {"optimal": 100_000}
    assert study[99_999].constants["B"] == pytest.approx(1.6)
