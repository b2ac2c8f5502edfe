"""Every proof that results/ holds, checked twice: by `optlaws verify`, and by the program in JavaScript.

`python -m tests.check_proofs` prints a line for each file and what is not checked, and ends with 1 where something is
not proven, or where only one of both proves it. The program in JavaScript takes three times as long as `verify`: with
`--each 4` it is given every fourth row of a table, and all that is in no table.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any

from optlaws.verification import verify_all
from tests.documents import ROOT

PROGRAM = ROOT / "optlaws" / "explorer" / "page" / "check_proof.mjs"
RESULTS = ROOT / "results"
Claims = list[dict[str, Any]]
#: lists of rows that are solved and proven one by one
TABLES = {"rows", "points"}


@cache
def node() -> str:
    """Node.js of this machine, or that of the browser's driver."""
    installed = which("node")
    if installed is not None:
        return installed
    from playwright._impl._driver import compute_driver_executable

    return str(compute_driver_executable()[0])


def run(*files: Path) -> subprocess.CompletedProcess[str]:
    """The program in JavaScript on files, a line of JSON of each."""
    return subprocess.run([node(), PROGRAM, "--json", *files], capture_output=True, text=True, check=False)


def certificates(data: object, path: str = "") -> Iterator[tuple[str, dict[str, Any]]]:
    """The certificates in plain data, each with where it is."""
    if isinstance(data, dict):
        if "problem" in data and data.keys() & {"contacts", "steps", "cells"}:
            yield path, data
            return
        for key, entry in data.items():
            yield from certificates(entry, f"{path}.{key}" if path else key)
    elif isinstance(data, list):
        for i, entry in enumerate(data):
            yield from certificates(entry, f"{path}[{i}]")


def thinned(data: Any, each: int) -> Any:
    """Plain data with every so many rows of its tables at their places, and None at those of the others."""
    if isinstance(data, list):
        return [thinned(entry, each) for entry in data]
    if not isinstance(data, dict) or "fastest" in data:  # the points of a front over the time are proven together
        return data
    return {
        key: [row if i % each == 0 else None for i, row in enumerate(entry)]
        if key in TABLES and isinstance(entry, list)
        else thinned(entry, each)
        for key, entry in data.items()
    }


def _second(data: Any) -> Claims:
    with TemporaryDirectory() as folder:
        file = Path(folder, "proofs.json")
        file.write_text(json.dumps(data), "utf-8")
        ended = run(file)
    if ended.returncode not in {0, 1, 3}:
        raise RuntimeError(ended.stderr)
    claims: Claims = json.loads(ended.stdout)
    return claims


def _compared(file: Path, proofs: list[str], second: Claims, total: Counter[str], reasons: Counter[str]) -> list[str]:
    """Count the claims of a file, and name what is not proven or is proven by one of both only."""
    first = verify_all(file)
    verdicts = {claim["path"]: claim["verdict"] for claim in second}
    total["proofs"] += len(proofs)
    total["proven by both"] += sum(verdicts.get(path) == "proven" for path in proofs)
    for claim in second:
        total[f"claims {claim['verdict']} by the second program"] += 1
        if claim["verdict"] == "not checked":
            reason = re.sub(r"^[0-9.e+-]+ is", "a bound is", claim["detail"].split("(of=")[0])
            reasons[f"the second program: {reason[:100]}"] += 1
    for verification in first.values():
        total["claims proven by verify"] += sum(claim.proven for claim in verification.claims)
        for unchecked in verification.unchecked:
            reasons[f"verify: {unchecked.name}"] += 1
    return [
        *(f"{file}: {path}: no verdict of the second program" for path in proofs if path not in verdicts),
        *(
            f"{file}: {claim['path']}: {claim['detail']} (the second program)"
            for claim in second
            if claim["verdict"] == "not proven"
        ),
        *(
            f"{file}: {place}: {claim} (verify)"
            for place, verification in first.items()
            for claim in verification.claims
            if not claim.proven
        ),
    ]


def main(each: int) -> int:
    """Check all files and print what was found."""
    data = {file: thinned(json.loads(file.read_text("utf-8")), each) for file in sorted(RESULTS.rglob("*.json"))}
    files = {file: proofs for file in data if (proofs := [path for path, _ in certificates(data[file])])}
    total, reasons, wrong = Counter[str](), Counter[str](), list[str]()
    with ThreadPoolExecutor(1) as beside:
        running: dict[Path, Future[Claims]] = {file: beside.submit(_second, data[file]) for file in files}
        for file, proofs in files.items():
            found = _compared(file, proofs, running[file].result(), total, reasons)
            wrong += found
            print(f"{file.relative_to(ROOT)}: {len(proofs)} proofs, {len(found)} not proven", flush=True)
    print(f"{len(files)} files: {', '.join(f'{count} {name}' for name, count in total.items())}")
    for reason, count in reasons.most_common():
        print(f"not checked, {count} times: {reason}")
    print(*wrong, sep="\n", end="")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    parser = ArgumentParser(prog="python -m tests.check_proofs")
    parser.add_argument("--each", type=int, default=1, help="check every so many rows of tables by the second program")
    sys.exit(main(parser.parse_args().each))
