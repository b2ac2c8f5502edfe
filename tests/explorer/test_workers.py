"""Heavy questions end when nobody waits for them, when their time is over, with the server; light ones never wait."""

import json
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from http.client import HTTPConnection
from pathlib import Path
from statistics import median

import pytest

from tests.explorer.talk import OPTIMAL, Server

#: the branch and bound of a formula that is neither convex nor soon done
HEAVY = {"laws": [{"problem": {"order": 4, "degree": 9, "minimise": "peak(cos(7*c)*sin(3*b))", "symmetric": False}}]}


def processor_time(parent: int) -> float:
    """Seconds of processor time of all descendants of a process that are alive."""
    spent = 0.0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[1]) == parent:
            spent += (int(fields[11]) + int(fields[12])) / 100.0 + processor_time(int(stat.parent.name))
    return spent


def wait_for_work(parent: int, seconds: float = 0.3) -> None:
    """Until the descendants of a process have worked so long more."""
    begun = processor_time(parent)
    while processor_time(parent) - begun < seconds:
        time.sleep(0.02)


def test_a_question_that_takes_long_ends_with_a_sentence(served: Server) -> None:
    assert served.ask("laws", HEAVY, patience=0.5) == {"error": "this takes more than 0.5 s", "late": 0.5}


def test_light_questions_do_not_wait_for_heavy_ones(served: Server) -> None:
    connections = [HTTPConnection(served.name, served.port, timeout=60) for _ in range(100)]
    for number, connection in enumerate(connections):
        question = json.loads(json.dumps(HEAVY))
        question["laws"][0]["problem"]["minimise"] = f"peak(cos({number + 7}*c)*sin(3*b))"
        connection.request("POST", "/api/laws?patience=100", json.dumps(question), {"Content-Type": "application/json"})
    time.sleep(0.3)
    passed = []
    for number in range(5):
        begin = time.monotonic()
        assert "panels" in served.ask("laws", {"laws": [OPTIMAL | {"title": f"light {number}"}]})["laws"][0]
        passed.append(time.monotonic() - begin)
    assert served.send("GET", "/main.js")[0].status == 200
    for connection in connections:
        connection.close()  # nobody waits for them any more
    assert median(passed) < 5.0  # a slice of the one before it, on a machine that may be busy; all of them take hours


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="reads the processor time of processes from /proc")
def test_what_nobody_waits_for_costs_nothing_and_ctrl_c_ends_all() -> None:
    arguments = [sys.executable, "-m", "optlaws", "explore", "cycloidal", "--no-browser", "--port", "0"]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None
        served = Server("127.0.0.1", int(running.stdout.readline().split()[2].rstrip("/").rpartition(":")[2]))
        served.ask("laws", {"laws": [OPTIMAL]})
        connection = HTTPConnection(served.name, served.port)
        body, kind = json.dumps(HEAVY), {"Content-Type": "application/json"}
        connection.request("POST", "/api/laws?patience=100", body, kind)
        wait_for_work(running.pid)
        connection.close()
        served.ask("laws", {"laws": [OPTIMAL | {"title": "another"}]})
        before = processor_time(running.pid)
        time.sleep(1.0)
        assert processor_time(running.pid) - before < 0.5
        with ThreadPoolExecutor(1) as pool:
            late = pool.submit(
                served.send, "POST", "/api/laws?patience=100", body.encode(), Content_Type="application/json"
            )
            wait_for_work(running.pid)
            running.send_signal(signal.SIGINT)
            complaints = running.communicate(timeout=10)[1]
            assert b"ended before its answer" in late.result()[1]
        assert running.returncode == 0
        assert complaints == ""
