"""The first questions come together: what is made when it is first used is made before."""

import json
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.explorer.talk import OPTIMAL, Server
from tests.internals.explorer import example

QUESTIONS = {
    "laws": {"laws": [OPTIMAL, {"name": "cubic"}]},
    "front": {"laws": [OPTIMAL], "over": ["B", "C"]},
    "export": {"kind": "csv", "view": "laws", "request": {"laws": [OPTIMAL]}, "points": 9},
    "cycle": {"study": example()},
    "residual": {"laws": [OPTIMAL]},
}


@pytest.mark.long
def test_the_first_questions_of_a_new_server_may_come_together() -> None:
    arguments = [sys.executable, "-m", "optlaws", "explore", "cycloidal", "--no-browser", "--port", "0"]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        address = running.stdout.readline().split()[2].rstrip("/")
        served = Server("127.0.0.1", int(address.rpartition(":")[2]))
        assert served.get_start() == {"view": "laws", "laws": [{"name": "cycloidal"}]}
        with ThreadPoolExecutor(len(QUESTIONS)) as pool:
            asked = [pool.submit(served.ask, name, question) for name, question in QUESTIONS.items()]
            answers = [one.result() for one in asked]
        assert running.poll() is None
        assert all("error" not in answer for answer in answers), json.dumps(answers)[:500]
        running.terminate()
