"""Whatever comes through a public door is taken or refused by an error of optlaws, at once."""

import json
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, seed, settings
from hypothesis import strategies as st

import optlaws
from optlaws import OptlawsError
from tests.documents import ROOT
from tests.internals.cli import exit_code
from tests.internals.files import reading
from tests.internals.jobs import job
from tests.internals.studies import StudyPoints, check, read_study
from tests.internals.synthesis import ENTRIES
from tests.sampling import examples

DEEP: Any = 1
for _ in range(3000):
    DEEP = [DEEP]

NUMBERS = st.sampled_from(
    [0, 1, -1, 2, 0.5, 1.8, 1e-300, 1e308, -1e308, 10**400, -(10**400), 10**9, 2**63, float("nan"), float("inf"), True]
)
TEXTS = st.sampled_from(
    ["", "C", "a\0b", "a\ud800", "9" * 5000, "x" * 100_000, "(" * 5000, "C" + "+C" * 4000, "1e999*C"]
)
SMALL = st.integers(0, 12) | st.floats(0.0, 2.0)
ANY = st.one_of(NUMBERS, TEXTS, SMALL, st.none(), st.just(DEEP), st.just({}), st.lists(NUMBERS | SMALL, max_size=4))

QUICK = settings(examples(60), database=None, suppress_health_check=list(HealthCheck))


#: of bounds, terms and arrays that the library makes itself, and of errors that are Python's
INNER = re.compile(
    r"got (?:at_most|at_least)\(|array\(|np\.\w+\(|\b0\.0\*|IndexError|KeyError|object at 0x|out of bounds"
)


@contextmanager
def a_door(names: str = "") -> Iterator[None]:
    """Nothing but an error of optlaws leaves, its text is short and can be printed, and it does not take long.

    It has one of the names of the user's entries, and nothing that the library made itself.
    """
    began = perf_counter()
    try:
        yield
    except OptlawsError as error:
        text = str(error)
        assert len(text) < 5000
        assert not INNER.search(text), text
        assert re.search(names, text), text
        text.encode()
    # a second on a machine that does nothing else
    assert perf_counter() - began < 5.0


CONSTRUCTORS: dict[str, Callable[..., Any]] = {
    "Window": lambda *a: optlaws.Window("b", *a[:4]),
    "Window of": lambda a, *_: optlaws.Window(a, 1.0),
    "Range": lambda a, b, *_: optlaws.between(a, b),
    "BoundaryConditions": lambda a, b, *_: optlaws.BoundaryConditions(a, b),
    "rest": lambda a, *_: optlaws.BoundaryConditions.rest(a),
    "Chebyshev": lambda a, *_: optlaws.Chebyshev(a),
    "Pieces": lambda a, b, c, *_: optlaws.Pieces(a, b, c),
    "BSplines": lambda a, b, c, *_: optlaws.BSplines(a, b, c),
    "savin": lambda a, b, *_: optlaws.savin(a, b),
    "smoothstep": lambda a, *_: optlaws.smoothstep(a),
    "PolynomialLaw": lambda a, b, c, *_: optlaws.PolynomialLaw(a, b, c),
    "a law at k": lambda a, b, *_: optlaws.smoothstep(4)(a, nu=b),
    "catalogue": lambda a, *_: optlaws.catalogue[a],
    "limit": lambda a, b, *_: optlaws.limit("D", a, order=b),
    "jerk limit": lambda a, b, c, *_: optlaws.limit("C", a, order=b, J=c),
    "weight": lambda a, *_: a * optlaws.C if isinstance(a, int | float) and a is not True else None,
    "from_json": lambda a, *_: optlaws.MotionLaw.from_json(a),
    "Follower": lambda a, b, *_: optlaws.Follower(a, b),
}


@pytest.mark.parametrize("name", CONSTRUCTORS)
@seed(15)
@QUICK
@given(a=ANY, b=ANY, c=ANY, d=ANY)
def test_constructors(name: str, a: object, b: object, c: object, d: object) -> None:
    with a_door():
        CONSTRUCTORS[name](a, b, c, d)


@seed(15)
@settings(QUICK, max_examples=examples(400).max_examples)
@given(name=st.sampled_from(list(ENTRIES)), value=ANY, basis=st.sampled_from(["chebyshev", "bsplines", "pieces"]))
@example(name="order", value=10**30, basis="chebyshev")
@example(name="breaks", value=10**9, basis="pieces")
def test_entries_of_a_problem_and_of_a_study(name: str, value: object, basis: str) -> None:
    entries = {"order": 4, "B": 1.8, "basis": basis, "degree": 9} | ({} if basis == "chebyshev" else {"breaks": 4})
    with a_door():
        optlaws.Problem.from_dict({**entries, name: value})
    with a_door():
        study = read_study(
            {"problem": entries | {"minimise": "{w}*C + {1-w}*D"}, "vary": {"w": [value], name: [value]}}
        )
        check(study, StudyPoints.of(study))
    with a_door():
        study = read_study({"problem": {k: v for k, v in entries.items() if k != name}, "vary": {name: [value, 1]}})
        check(study, StudyPoints.of(study))


QUANTITIES = st.sampled_from(
    [
        "0 mm",
        "1e-9 mm",
        "35 mm",
        "51 km",
        "-3 mm",
        "0 s",
        "1e-300 s",
        "0.1 s",
        "1e9 s",
        "2 g",
        "45 deg",
        "1 parsec",
        "mm",
    ]
)
#: what each names of its user's where it refuses
MACHINES: dict[str, tuple[Callable[..., Any], str]] = {
    "stroke": (
        lambda a, b: (
            optlaws.Follower.from_vibration(b, duration="0.1 s")
            .response(optlaws.smoothstep(4))
            .in_units(a, duration="0.1 s")
        ),
        "stroke|vibration",
    ),
    "cycle": (
        lambda a, b: optlaws.Cycle([optlaws.Rise(a, b), optlaws.Return(duration="0.1 s")], period="0.3 s"),
        "Rise|segment|period|^by|^duration",
    ),
    "move": (
        lambda a, b: optlaws.Cycle([optlaws.Move(a, "0.1 s", law="cycloidal"), optlaws.Dwell(b)], period="0.3 s"),
        "Move|segment|period|come back|advance|^by|^duration",
    ),
    "export": (lambda a, b: optlaws.smoothstep(3).export("csv", stroke=a, duration=b), "stroke|duration"),
    "task": (
        lambda a, b: optlaws.smoothstep(3).export("codesys-cambuilder", stroke="1 mm", duration=a, task=b),
        "duration|task",
    ),
    "stroke of a least time": (
        lambda a, b: optlaws.fastest(optlaws.Problem(order=2), stroke=a, limits={"acceleration": b}),
        "stroke|acceleration",
    ),
    "table": (lambda a, b: optlaws.split_table([a] * 12, [b] * 12), "x|y|places"),
    "limits": (
        lambda a, b: optlaws.fastest(
            optlaws.Problem(order=2), stroke="1 mm", limits={"velocity": a, "acceleration": b}
        ),
        "velocity|acceleration",
    ),
}


@pytest.mark.parametrize("name", MACHINES)
@seed(15)
@settings(QUICK, max_examples=examples(30).max_examples)
@given(a=QUANTITIES | ANY, b=QUANTITIES | ANY)
def test_doors_of_machines_name_what_they_refuse(name: str, a: object, b: object) -> None:
    door, names = MACHINES[name]
    with a_door(names):
        door(a, b)


PATHS = st.lists(st.integers(0, 30), min_size=1, max_size=4)


def damaged(data: Any, path: list[int], value: object) -> Any:
    """A copy in which the value stands at a place."""
    if not path or not isinstance(data, dict | list) or not data:
        return value
    if isinstance(data, list):
        place = path[0] % len(data)
        return [damaged(one, path[1:], value) if i == place else one for i, one in enumerate(data)]
    key = list(data)[path[0] % len(data)]
    return {**data, key: damaged(data[key], path[1:], value)}


SOLUTION = optlaws.synthesize(optlaws.Problem(B=1.8, order=3, basis=optlaws.Chebyshev(5)))
STORED: dict[str, tuple[Callable[[Any], object], Any]] = {
    "polynomial": (optlaws.MotionLaw.from_dict, SOLUTION.law.to_dict()),
    "piecewise": (optlaws.MotionLaw.from_dict, optlaws.catalogue["modified sine"].law.to_dict()),
    "problem": (optlaws.Problem.from_dict, SOLUTION.problem.to_dict()),
    "certificate": (optlaws.Certificate.from_dict, SOLUTION.certificate.to_dict()),
}


@pytest.mark.parametrize("kind", STORED)
@seed(15)
@settings(QUICK, max_examples=examples(200).max_examples)
@given(path=PATHS, value=ANY)
def test_stored_values(kind: str, path: list[int], value: object) -> None:
    read, data = STORED[kind]
    with a_door():
        read(damaged(data, path, value))


@seed(15)
@settings(QUICK, max_examples=examples(300).max_examples)
@given(text=st.text(st.sampled_from(list("CDJB()+-*/=,.0129emax_ \t\n\0é")), max_size=40) | TEXTS)
def test_objectives_as_text(text: str) -> None:
    with a_door():
        optlaws.Problem(order=4, minimise=text)


def test_a_long_objective_is_read_in_linear_time() -> None:
    with a_door():
        optlaws.Problem(order=4, minimise="C" + " " * 9000 + "+D")


FILES = sorted((ROOT / "problems").glob("*.toml"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.stem)
def test_problem_files_of_each_job(tmp_path: Path, file: Path) -> None:
    lines = file.read_text("utf-8").splitlines()
    places = [
        i for i, line in enumerate(lines) if re.match(r"\w+ *= *[\"\w.-]+ *$", line) and not line.startswith("job")
    ]
    copy = tmp_path / "problem.toml"
    for i in places[:8]:
        for value in ("9" * 400, '"\\ud800"', "[" * 200 + "]" * 200, "[[1], {}]"):
            damaged_line = f"{lines[i].partition('=')[0]}= {value}"
            copy.write_text("\n".join([*lines[:i], damaged_line, *lines[i + 1 :]]), "utf-8")
            with a_door(), pytest.raises(OptlawsError):
                job.done(copy).write(tmp_path / "out")


@pytest.mark.parametrize(
    "content",
    [
        b"job = " + b"9" * 5000,
        b"job = " + b"[" * 100_000,
        b"job = " + b"[" * 1000 + b"]" * 1000,
        b"\0",
        b'"\\ud800" = 1',
        b"\xff",
    ],
    ids=["digits", "open", "deep", "nul", "surrogate", "no text"],
)
def test_files_that_are_none(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "problem.toml"
    file.write_bytes(content)
    for door in (job.done, read_study, reading.json_file):
        with a_door(), pytest.raises(OptlawsError):
            door(file)


def test_paths_that_are_no_files(tmp_path: Path) -> None:
    for path in (Path("a\0b"), Path("a\ud800"), Path("/dev/zero"), tmp_path, tmp_path / ("x" * 300)):
        with a_door(), pytest.raises(OptlawsError):
            job.done(path).write(tmp_path / "out")


def test_a_byte_order_mark_is_read(tmp_path: Path) -> None:
    file = tmp_path / "law.json"
    file.write_bytes(b"\xef\xbb\xbf" + json.dumps(optlaws.smoothstep(3).to_dict()).encode())
    assert optlaws.MotionLaw.from_dict(reading.json_file(file)) == optlaws.smoothstep(3)


@pytest.mark.parametrize(
    "value", ["nan", "inf", "1e308", "-1e308", "1" + "0" * 400, "9" * 5000, "x", "", "2.5", "100000"]
)
def test_values_of_the_command(capsys: pytest.CaptureFixture[str], value: str) -> None:
    solve = ["solve", "--order", "3", "--degree", "5", "--peak-velocity", "1.8"]
    for line in (
        ["law", "--order", value, "--z", "1"],
        [*solve, "--degree", value] if value != "100000" else ["solve", "--order", "3", "--degree", value],
        ["solve", "--order", value, "--degree", "5"],
        [*solve, "--basis", "pieces", "--breaks", value, "--most", "J=-1"],
        ["solve", "--order", "3", "--degree", "5", "--peak-velocity", value, "--most-jerk", "0"],
        ["follower", "cycloidal", "--frequency", value, "--damping", "-1"],
        ["catalogue", value or "x"],
    ):
        with a_door():
            assert exit_code(line) in {0, 2, 3}
        assert len(capsys.readouterr().err) < 5000
