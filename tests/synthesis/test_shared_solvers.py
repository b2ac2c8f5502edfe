"""One solver is used by one thread at a time, and its cache is small."""

import subprocess
import sys

from tests.documents import ROOT

SCRIPT = """
from concurrent.futures import ThreadPoolExecutor
from optlaws import Problem, synthesize
problems = [Problem(order=4, B=1.859), Problem(B=1.7, order=3, minimise="rms_c")]
serial = [synthesize(problem).law.to_dict() for problem in problems]
with ThreadPoolExecutor(8) as threads:
    found = list(threads.map(lambda i: synthesize(problems[i % 2]).law.to_dict(), range(64)))
assert found == serial * 32
"""


def test_threads_may_solve_problems_of_one_shape() -> None:
    command = [sys.executable, "-X", "faulthandler", "-c", SCRIPT]
    answer = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=120)
    assert answer.returncode == 0, answer.stderr
