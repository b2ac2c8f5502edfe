"""Every format of ours with one value changed: it is refused, or what it then says is still true.

`python -m tests.verification.tampered_formats` changes every value of every format in every way and counts; with a
number, every so many of the changes, and with names behind it those formats alone.
"""

import json
import math
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from pathlib import Path as File
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from optlaws import (
    Axes,
    Certificate,
    Chebyshev,
    Clearance,
    Cycle,
    DriveLimit,
    Dwell,
    FastestMove,
    Free,
    InfeasibleProblem,
    Machine,
    MotionLaw,
    MoveLimit,
    OptlawsError,
    Problem,
    ProblemArray,
    ProvenFront,
    Return,
    Rise,
    SolutionArray,
    TimeFront,
    at_least,
    catalogue,
    drive_limit,
    fastest,
    open_study,
    pareto_front,
    proven_front,
    run_study,
    smoothstep,
    synthesize,
    synthesize_array,
    time_front,
)
from optlaws.typing import Bound, Overlap
from optlaws.verification import Verification, verify_all
from tests.internals.mechanisms import move_limit
from tests.internals.studies import Serial
from tests.internals.synthesis import LONG, least_time, limit_of_plane
from tests.mechanisms.drives.test_move_limits import MADE
from tests.verification.tampering import SOLUTIONS, Data, Path, changed, overstated, value_at, wrong_constants

#: by how much a number may be off that rounding explains
CLOSE = 2e-9
#: of the search, of the places of what is not unique, or meant for people
IDLE = {"about", "seconds", "iterations", "versions", "starts", "error", "tried"}


class Dropped:
    """In place of a value: its key is left out."""

    def __repr__(self) -> str:
        return "left out"


DROPPED = Dropped()


def places(data: Any, path: Path = ()) -> Iterator[Path]:
    """Every value, every object and every list, whatever it says."""
    if path:
        yield path
    inside = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in inside:
        yield from places(value, (*path, key))


def changes(value: object) -> list[Any]:
    """What may stand in place of a value: near, far, of the other sign, no number, of another type, or nothing."""
    if isinstance(value, bool):
        return [not value, 7, "no", DROPPED]
    if isinstance(value, int | float):
        near = [value * (1.0 + 1e-6), value * 2 + 1, -value, value + 1, 0]
        return [*near, math.nan, 1e300, 10**400, "7", None, [value], DROPPED]
    if isinstance(value, str):
        return [f"{value}x", "", "C", 7, None, DROPPED]
    if isinstance(value, list):
        return [value[:-1], [*value, *value[-1:]], value[::-1], [], {}, None, 7, DROPPED]
    return [{}, [], None, 7, "law", DROPPED]


def changes_by_kind(data: Data, each: int = 6) -> Iterator[tuple[Path, Any]]:
    """Places with what may stand there: of each kind of value every change at the first, then every so many, in turn.

    Values whose places differ by indices alone are of one kind.
    """
    seen: Counter[tuple[str, ...]] = Counter()
    for path in places(data):
        kind = tuple("*" if isinstance(key, int) else key for key in path)
        every = changes(value_at(data, path))
        yield from (
            (path, value) for value in (every[seen[kind] % min(each, len(every)) :: each] if seen[kind] else every)
        )
        seen[kind] += 1


def tampered(data: Data, path: Path, value: object) -> Data:
    """A copy with another value at a place, or without it."""
    copied = changed(data, path, None if value is DROPPED else value)
    if value is DROPPED:
        del value_at(copied, path[:-1])[path[-1]]
    return copied


@dataclass(frozen=True)
class Format:
    """A format: a file of it, how it is read, and what is wrong of one that was changed and is believed.

    Attributes
    ----------
    data
        The file.
    read
        What reads it, if anything but `verify` does, and uses what was read.
    wrong
        What is false of a changed file by its reader, given what was read.
    verified
        Whether `verify` takes it.
    wrong_proven
        What is false of a changed file whose every claim is proven.
    wrong_verified
        What is false of a changed file that is verified, proven or not.
    """

    data: Data
    read: Callable[[Data], Any] | None = None
    wrong: Callable[[Data, Any], list[str]] = lambda _, __: []
    verified: bool = True
    wrong_proven: Callable[[Data, dict[str, Verification]], list[str]] = lambda _, __: []
    wrong_verified: Callable[[Data, dict[str, Verification]], list[str]] = lambda _, __: []


def outcome(form: Format, data: Data) -> tuple[str, list[str]]:
    """Whether a changed file is refused or harmless, and what is wrong of it."""
    verdict, wrong = "refused", []
    if form.read is not None:
        try:
            read = form.read(data)
        except OptlawsError:
            pass
        else:
            verdict, wrong = "harmless", form.wrong(data, read)
    if form.verified:
        try:
            verifications = verify_all(data)
        except OptlawsError:
            pass
        else:
            wrong = [*wrong, *form.wrong_verified(data, verifications)]
            if all(one.proven for one in verifications.values()):
                verdict, wrong = "harmless", [*wrong, *form.wrong_proven(data, verifications)]
    return verdict, wrong


def plain(data: object) -> Data:
    """As the file would be read."""
    value: Data = json.loads(json.dumps(data, allow_nan=False))
    return value


def close(first: object, second: object) -> bool:
    """Whether arrays are the same but for rounding."""
    one, other = np.asarray(first), np.asarray(second)
    if one.shape != other.shape or one.dtype.kind not in "fiub" or other.dtype.kind not in "fiub":
        return one.shape == other.shape and bool((one == other).all())
    size = np.nanmax(np.abs(other), initial=1.0) if other.size else 1.0
    return bool(np.allclose(one, other, rtol=CLOSE, atol=CLOSE * size, equal_nan=True))


def solution(problem: Problem, bound: Bound = "quick") -> Format:
    data = plain(synthesize(problem, bound=bound).to_dict())
    (true,) = verify_all(data).values()
    return Format(data, wrong_verified=lambda stored, known: overstated(stored, true, *known.values()))


def array(problems: ProblemArray, places_of: Sequence[int], bound: Bound = "quick") -> Format:
    true = synthesize_array(problems, bound=bound)[np.array(places_of)]
    data = plain(true.to_dict())

    def wrong(_: Data, stored: SolutionArray) -> list[str]:
        differing = [
            name
            for name in ("shape", "status", "objective", "B", "C", "J", "z_series", "best_possible")
            if not close(getattr(stored, name), getattr(true, name))
        ]
        higher = stored.lower_bound > true.lower_bound * (1.0 + CLOSE)
        asked = [i for i in range(true.size) if _problem(stored, i) != _problem(true, i)]
        off = [i for i in range(true.size) if not _is_proven(stored, i)]
        return [*differing, *(["lower_bound"] if higher.any() else []), *map(str, asked), *map(str, off)]

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        found = []
        for i, row in enumerate(stored["solutions"]):
            genuine = data["solutions"][i] if i < len(data["solutions"]) else {}
            if row.get("status") == "infeasible" != genuine.get("status"):
                found.append(f"solutions[{i}] is said to be infeasible")
            if "objective" in row:
                found += overstated_row(row, genuine)
        return found

    return Format(data, SolutionArray.from_dict, wrong, wrong_proven=wrong_proven)


def same_problem(first: Data, second: Data) -> bool:
    """Whether two problems are one, whatever of it they leave to be filled in."""
    return Problem.from_dict(first) == Problem.from_dict(second)


def overstated_row(row: Data, genuine: Data) -> list[str]:
    if not same_problem(row["problem"], genuine["problem"]):
        return ["a row of another problem"]
    # null states nothing, as an entry that is left out
    stated = genuine["objective"] if row.get("objective") is None else row["objective"]
    off = abs(stated - genuine["objective"]) > CLOSE * abs(genuine["objective"])
    high = (row.get("lower_bound") or -math.inf) > genuine["lower_bound"] + CLOSE * abs(genuine["lower_bound"])
    return [*(["objective"] if off else []), *(["lower bound"] if high else [])]


def _problem(laws: SolutionArray, place: int) -> str:
    result = laws.result(place)
    return repr(getattr(result, "problem", None))


def _is_proven(laws: SolutionArray, place: int) -> bool:
    """Whether what a place says follows from what it holds."""
    result: Any = laws.result(place)
    if isinstance(result, InfeasibleProblem):
        proof: Any = result.proof
        return bool(proof.proves_infeasible) and proof.problem == result.problem
    if isinstance(result, OptlawsError):
        return True
    known = [result.certificate.bound, -math.inf if result.best_possible is None else result.best_possible]
    known += [proof.bound for proof in (result.power_certificate, result.peak_certificate) if proof is not None]
    return bool(result.lower_bound <= max(known) * (1.0 + CLOSE)) and (result.gap <= 1e-8) == (
        result.status.value == "optimal"
    )


def certificate(data: object, read: Callable[[Data], Any], best: float, *, verified: bool = True) -> Format:
    """A lower bound that stands alone; `best` is the least objective of its problem."""
    form, most = plain(data), best * (1.0 + CLOSE)

    def wrong(stored: Data, proof: Any) -> list[str]:
        above = same_problem(stored["problem"], form["problem"]) and proof.bound > most
        return [f"bound {proof.bound!r} above {best!r}"] if above else []

    def wrong_proven(stored: Data, verifications: dict[str, Verification]) -> list[str]:
        (one,) = verifications.values()
        same = same_problem(stored["problem"], form["problem"])
        stated = stored.get("bound") or -math.inf
        above = same and max(stated, -math.inf if one.bound is None else one.bound) > most
        return [f"bound {stated!r}, {one.bound!r} above {best!r}"] if above else []

    return Format(form, read, wrong, verified, wrong_proven)


def no_law(problem: Problem) -> Format:
    """A proof that a problem has no law."""
    try:
        synthesize(problem)
    except InfeasibleProblem as error:
        proof: Any = error.proof

    def has_law(stored: Data) -> list[str]:
        try:
            synthesize(Problem.from_dict(stored["problem"]))
        except OptlawsError:
            return []
        return ["a law exists"]

    def wrong(stored: Data, proof: Certificate) -> list[str]:
        return has_law(stored) if proof.proves_infeasible else []

    def wrong_proven(stored: Data, verifications: dict[str, Verification]) -> list[str]:
        return has_law(stored) if any(one.infeasible for one in verifications.values()) else []

    return Format(plain(proof.to_dict()), Certificate.from_dict, wrong, wrong_proven=wrong_proven)


def move_limit_file(limit: MoveLimit) -> Format:
    """A limit of a move: of another move it is that of the other move, computed from the file."""

    def wrong(_: Data, stored: MoveLimit) -> list[str]:
        genuine = limit if stored.move == limit.move else anew(stored)
        if genuine is None or genuine.minimise != stored.minimise:
            return ["no limit is known of its move"]
        high = stored.value > genuine.attained + CLOSE * abs(genuine.attained)
        low = stored.attained < genuine.value - CLOSE * abs(genuine.value)
        return [*(["value"] if high else []), *(["attained"] if low else [])]

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        read = MoveLimit.stated(stored)[0]
        names = ("unit", "dimension")
        return [*wrong(stored, read), *(name for name in names if not close(stored[name], getattr(read, name)))]

    return Format(plain(limit.to_dict()), MoveLimit.from_dict, wrong, wrong_proven=wrong_proven)


def anew(limit: MoveLimit) -> MoveLimit | None:
    """The limit of what a limit states of its move, computed again, or None."""
    move = limit.move
    if limit.minimise == "time":
        # a proof that the time given is too short
        move = replace(move, minimise="time", duration=None, recovered=0.0, heat=0.0)
    elif limit.minimise != move.minimise:
        # a proof that the load is beyond the torque however long the time is
        free = {name: bound for name, bound in dict(move.limits).items() if name not in {"torque", "force"}}
        slow = (1.0 if move.duration is None else move.duration) * LONG
        move = replace(move, minimise=limit.minimise, duration=slow, limits=free, recovered=0.0, heat=0.0)
    try:
        return move_limit(move)
    except OptlawsError:
        return None


def drive_limit_file(limit: DriveLimit) -> Format:
    """A limit without dimensions: of another plane it is that of the other plane."""

    def wrong(_: Data, stored: DriveLimit) -> list[str]:
        same = (stored.plane, stored.minimise, stored.unit) == (limit.plane, limit.minimise, limit.unit)
        try:
            genuine = limit if same else limit_of_plane(stored.plane, stored.minimise, stored.unit)
        except OptlawsError:
            return ["no limit is known of its plane"]
        # of the least time it is the plane that is in the unit
        unit = stored.unit if stored.minimise == "time" and not same else 1.0
        high = stored.value > unit * (genuine.attained + CLOSE * abs(genuine.attained))
        low = stored.attained < unit * (genuine.value - CLOSE * abs(genuine.value))
        return [*(["value"] if high else []), *(["attained"] if low else [])]

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        return wrong(stored, DriveLimit.stated(stored))

    return Format(plain(limit.to_dict()), DriveLimit.from_dict, wrong, wrong_proven=wrong_proven)


def overlap_file(true: Overlap) -> Format:
    """Axes that overlap: of another machine they are those of the other one, sought again from the file."""

    def wrong(stored: Data, read: Overlap) -> list[str]:
        same = (stored["given"], stored["goal"], stored["of"]) == tuple(form[name] for name in ("given", "goal", "of"))
        genuine = true if same else read.again()
        reached = read.axes.duration if read.goal == "period" else read.objective
        faults = {
            "objective": not close(read.objective, reached) or read.objective < genuine.lower_bound * (1.0 - CLOSE),
            "lower bound": read.lower_bound > genuine.objective * (1.0 + CLOSE),
            "interlock": bool(read.axes.broken),
        }
        return [name for name, found in faults.items() if found]

    def wrong_verified(stored: Data, verifications: dict[str, Verification]) -> list[str]:
        read = Overlap.from_dict(stored)
        (one,) = verifications.values()
        binding = [] if sorted(read.binding) == sorted(read.again().binding) else ["binding"]
        return [*wrong(stored, read), *binding, *([] if len(one.recomputed) > 1 else ["nothing is left unchecked"])]

    form = plain(true.to_dict())
    return Format(form, wrong_proven=wrong_verified)


def drawn_axes(goal: str) -> Overlap:
    """Two axes with an interlock, whose period or whose acceleration is least."""
    law: Any = {"law": "cycloidal"}
    rest = {"least": "0 s"}
    slide = [Rise("0.1 m", "0.2 s", **law), Dwell("0.4 s", **rest), Return("0.1 m", "0.2 s", **law), Dwell()]
    tool = [
        Dwell("0.2 s", **rest),
        Rise("50 mm", "0.1 s", **law),
        Dwell("0.1 s"),
        Return("50 mm", "0.1 s", **law),
        Dwell(),
    ]
    rule = Clearance("tool", over="slide", most=[("90 mm", "5 mm"), ("95 mm", "50 mm")])
    limits = {"acceleration": "20 m/s^2"} if goal == "period" else {}
    given = Axes({"slide": {"segments": slide, "limits": limits}, "tool": tool}, period="1 s", interlocks=[rule])
    return given.fastest() if goal == "period" else given.least_acceleration("tool")


def least_time_file(move: FastestMove) -> Format:
    """A least time: of another move it is that of the other move."""
    data = plain(move.to_dict())

    def wrong(_: Data, read: FastestMove) -> list[str]:
        genuine = (move.least if read.least.move == move.least.move else least_time(read.least.move)).duration
        low = read.duration < genuine * (1.0 - 1e-6)
        high = read.none_below > genuine * (1.0 + CLOSE)
        return [*(["duration"] if low else []), *(["none below"] if high else [])]

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        read = FastestMove.from_dict({"unit": "m", **stored})
        return [*wrong(stored, read), *overstated_row(stored["solution"], read.least.solution.to_dict())]

    return Format(data, FastestMove.from_dict, wrong, wrong_proven=wrong_proven)


def time_front_file(true: TimeFront) -> Format:
    """A front over the time of a move: each value is that of its law, and no bound is above it."""

    def wrong(_: Data, read: TimeFront) -> list[str]:
        values = [point.value for point in read]
        return [f"at {point.duration}" for point, value in zip(read, values, strict=True) if point.lower_bound > value]

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        faults = []
        for row, genuine in zip(stored["points"], form["points"], strict=False):
            same = same_problem(row["solution"]["problem"], genuine["solution"]["problem"])
            if same and not close(row["duration"], genuine["duration"]):
                faults.append("duration")
            off = abs(row["value"] / genuine["value"] - 1.0) > CLOSE
            high = (row["lower_bound"] or -math.inf) > genuine["value"] * (1.0 + CLOSE)
            faults += [*(["value"] if same and off else []), *(["lower bound"] if same and high else [])]
        return faults

    form = plain(true.to_dict())
    return Format(form, TimeFront.from_dict, wrong, wrong_proven=wrong_proven)


def claims_file(data: Data) -> Format:
    """Problems each with a proof that it has no law, as results of jobs keep them; or a law with its proof."""
    form = plain(data)

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        faults = []
        for name, row in stored.items():
            genuine: Any = form.get(name)
            if genuine is None or not isinstance(row, dict):
                continue
            if "objective" in genuine and row.get("objective") is not None:
                faults += overstated_row(row, genuine)
            asked = row.get("asked") or genuine.get("asked")
            if row.get("status") == "infeasible" and not same_problem(asked, genuine["asked"]):
                try:
                    synthesize(Problem.from_dict(asked))
                except OptlawsError:
                    continue
                faults.append(name)
        return faults

    return Format(form, wrong_proven=wrong_proven)


def front() -> Format:
    data = plain(
        pareto_front(Problem(order=2, basis=Chebyshev(3)), over=("B", "C"), points=2, between=(1.5, 1.6)).to_dict()
    )

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        rows = zip(stored["points"], data["points"], strict=True)
        found = [line for row, genuine in rows for line in overstated_row(row, genuine)]
        names = [] if stored["over"] == data["over"] or not stored["points"] else ["over"]
        return [*found, *names, *([] if close(stored["values"], data["values"]) else ["values"])]

    return Format(data, wrong_proven=wrong_proven)


def along() -> Format:
    true = proven_front(Problem(order=2, basis=Chebyshev(3)), "B", between=(1.5, 1.6), gap=1e-2)
    data = plain(true.to_dict())

    def wrong(stored: Data, read: ProvenFront) -> list[str]:
        if (
            not same_problem(stored["problem"], data["problem"])
            or read.between[0] < 1.5 - 0.1
            or read.between[1] > 1.6 + 0.1
        ):
            return []
        values = [value for value in np.linspace(*true.between, 5) if read.between[0] <= value <= read.between[1]]
        return [f"at {v}" for v in values if read.lower(v) > true.upper(v) * (1.0 + CLOSE) or not read.gap >= 0.0]

    def wrong_proven(stored: Data, verifications: dict[str, Verification]) -> list[str]:
        (one,) = verifications.values()
        return [] if one.gap is not None and stored["gap"] >= one.gap - CLOSE else [f"gap {stored['gap']!r}"]

    return Format(data, ProvenFront.from_dict, wrong, wrong_proven=wrong_proven)


def law_with_constants(law: MotionLaw) -> Format:
    data = plain({"law": law.to_dict(), "constants": law.constants.to_dict()})

    def wrong_proven(stored: Data, verifications: dict[str, Verification]) -> list[str]:
        (one,) = verifications.values()
        return wrong_constants(stored, one)

    return Format(data, wrong_proven=wrong_proven)


def rows_of_a_table() -> Format:
    good = synthesize(Problem(B=1.6, order=2, basis=Chebyshev(3)))
    none = no_law(Problem(B=1.05, order=3, basis=Chebyshev(3))).data
    rows: list[Any] = [
        {"asked": good.problem.to_dict(), "status": "optimal", "solution": good.to_dict()},
        {"asked": none["problem"], "status": "infeasible", "proof": none},
    ]
    data = plain({"rows": rows})

    def wrong_proven(stored: Data, _: dict[str, Verification]) -> list[str]:
        found = []
        # an empty row claims nothing
        for row in filter(None, stored["rows"] if isinstance(stored.get("rows"), list) else []):
            asked = row.get("asked") or none["problem"]
            if row.get("status") == "infeasible" and not same_problem(asked, none["problem"]):
                found.append("another problem is said to have no law")
            if row.get("solution"):
                found += overstated_row(row["solution"], data["rows"][0]["solution"])
        return found

    return Format(data, wrong_proven=wrong_proven)


def law(value: MotionLaw) -> Format:
    """A law says no more than what it is: any other is read as what it is, its constants finite or infinite."""

    def use(stored: Data) -> MotionLaw:
        read = MotionLaw.from_dict(stored)
        assert MotionLaw.from_json(read.to_json()) == read
        return read

    def wrong(_: Data, read: MotionLaw) -> list[str]:
        k = np.linspace(0.0, 1.0, 33)
        below = float(np.abs(read.b(k)).max()) > read.constants.B.value * (1.0 + CLOSE) + CLOSE
        return ["B"] if below else []

    return Format(plain(value.to_dict()), use, wrong, verified=False)


def given(data: object, use: Callable[[Data], Any]) -> Format:
    """What was given to be computed: it claims nothing, and any change gives another or an error."""
    return Format(plain(data), use, verified=False)


def study() -> Format:
    """The file of a study, which its seal belongs to: nothing in it may change."""
    asked = {"title": "t", "problem": {"order": 3, "degree": 3}, "vary": {"B": [1.6, 1.7], "minimise": ["C", "rms_c"]}}
    with TemporaryDirectory() as out:
        run_study(asked, out, executor=Serial())
        kept = {file.name: file.read_bytes() for file in File(out).iterdir()}
    data: Data = json.loads(kept["study.json"])

    def read(stored: Data) -> Any:
        with TemporaryDirectory() as place:
            for name, content in kept.items():
                (File(place) / name).write_bytes(content)
            (File(place) / "study.json").write_text(json.dumps(stored, indent=1) + "\n", "utf-8")
            return [(point.inputs, point.problem) for point in open_study(place)]

    return Format(data, read, lambda stored, _: [] if stored == data else ["a changed study is read"], verified=False)


def _moved(cycle: Cycle) -> float:
    return float(cycle(0.05))


#: what takes long to be verified
SLOW = {"least time of a drive", *(f"move limit, {name}" for name in MADE if name != "rms torque of a press")}


@cache
def formats() -> dict[str, Callable[[], Format]]:
    """Each format with a small file of it, made when it is asked for."""
    plain_problem = Problem(B=1.7, order=2, basis=Chebyshev(3))
    power = Problem(B=1.6, order=2, basis=Chebyshev(3), minimise="D")
    held_up = Problem(B=at_least(2.2), order=2, basis=Chebyshev(3), minimise="rms_c")
    unlikely = Problem(B=1.05, order=3, basis=Chebyshev(3))
    machine = Machine([[0.0, 1.0], [-400.0, -2.0]], [[0.0], [400.0]], [[1.0, 0.0]], [[0.0]], inputs="a", outputs=["x"])
    cycle = Cycle(
        [Rise("35 mm", "120 deg"), Dwell("90 deg"), Return()],
        speed="200 rpm",
        limits={"velocity": "616 mm/s"},
        drive={"mass": "2 kg"},
    )
    free = Cycle(
        [Free("60 mm", "0.3 s", via=[("0.1 s", "40 mm")]), Return("60 mm", "0.3 s", law=smoothstep(3)), Dwell()],
        period="1 s",
        load={"period": "20 ms", "damping": 0.05, "mass": "2 kg"},
    )
    axes = Axes({"table": [Rise("45 deg", "400 ms"), Dwell(), Return(to="0 deg", duration="0.3 s")]}, period="2 s")
    quick = fastest(Problem(order=2, basis=Chebyshev(3)), stroke="100 mm", limits={"acceleration": "8 m/s^2"})
    limited = Cycle([Rise("35 mm", "180 deg"), Return()], speed="60 rpm", limits={"acceleration": "20 m/s^2"}, degree=3)
    in_array = {"order": 3, "basis": Chebyshev(3)}
    return {
        **{name: partial(solution, *given) for name, given in SOLUTIONS.items()},
        "array": lambda: array(ProblemArray(B=np.linspace(1.02, 2.0, 60), **in_array), [2, 30, 50]),
        "array, solved alone": lambda: array(ProblemArray(B=np.array([1.05, 1.6, 0.5]), **in_array), [0, 1, 2]),
        "array of least power": lambda: array(
            ProblemArray(B=np.linspace(1.5, 2.0, 30), minimise="D", **in_array), [3, 20]
        ),
        "array with tight bounds": lambda: array(
            ProblemArray(B=np.array([1.5, 1.6]), order=2, basis=Chebyshev(3), minimise="D"), [0, 1], "tight"
        ),
        "front": front,
        "proven front": along,
        "table": rows_of_a_table,
        "certificate": lambda: certificate(
            synthesize(plain_problem).certificate.to_dict(), Certificate.from_dict, synthesize(plain_problem).objective
        ),
        "relaxed certificate": lambda: certificate(
            synthesize(power, bound="tight").certificate.to_dict(), Certificate.from_dict, synthesize(power).objective
        ),
        "power certificate": lambda: certificate(
            _given(synthesize(power, bound="tight").power_certificate),
            Certificate.from_dict,
            synthesize(power, bound="tight").objective,
        ),
        "peak certificate": lambda: certificate(
            _given(synthesize(held_up, bound="tight").peak_certificate),
            Certificate.from_dict,
            synthesize(held_up, bound="tight").objective,
            verified=False,
        ),
        "no law": lambda: no_law(unlikely),
        "law with constants": lambda: law_with_constants(smoothstep(3)),
        "piecewise law with constants": lambda: law_with_constants(catalogue["modified sine"].law),
        "polynomial law": lambda: law(smoothstep(3)),
        "piecewise law": lambda: law(catalogue["modified trapezoid"].law),
        "problem": lambda: given(
            Problem(B=1.7, order=3, J=80.0, basis=Chebyshev(5)).to_dict(),
            lambda stored: repr(Problem.from_dict(stored)),
        ),
        "cycle": lambda: given(cycle.to_dict(), lambda stored: _moved(Cycle.from_dict(stored))),
        "cycle with a free motion": lambda: given(free.to_dict(), lambda stored: _moved(Cycle.from_dict(stored))),
        "axes": lambda: given(axes.to_dict(), lambda stored: [_moved(one) for one in Axes.from_dict(stored).values()]),
        "machine": lambda: given(
            machine.to_dict(), lambda stored: Machine.from_dict(stored).response(smoothstep(3)).peak("x")
        ),
        "study": study,
        "limit of a drive": lambda: drive_limit_file(drive_limit("(1 + 0.6*a)*c + 0.3*b^2 + 3*a", "rms torque", B=2.2)),
        "least time of a drive": lambda: drive_limit_file(drive_limit("c + 2", "time", P=7.0)),
        "overlap of least period": lambda: overlap_file(drawn_axes("period")),
        "overlap of least acceleration": lambda: overlap_file(drawn_axes("acceleration")),
        "least time": lambda: least_time_file(quick),
        "front over the time": lambda: time_front_file(time_front(quick, "rms acceleration", points=2)),
        "greatest speed": lambda: claims_file(limited.fastest().claims()),
        "run-in": lambda: claims_file(limited.run_in("90 deg", over="120 deg").claims()),
        **{f"move limit, {name}": partial(_limit_of_move, name) for name in MADE},
    }


def _limit_of_move(name: str) -> Format:
    return move_limit_file(MADE[name]())


def _given(proof: Any) -> object:
    assert proof is not None
    return proof.to_dict()


def main(each: int, names: Sequence[str]) -> None:
    """Count what becomes of every so many of the changes of all values."""
    total: Counter[str] = Counter()
    for name in names or list(formats()):
        form, counts, wrong = formats()[name](), Counter[str](), []
        known = list(places(form.data))
        counts["values"] = len(known)
        every = [(path, value) for path in known for value in changes(value_at(form.data, path))]
        for path, value in every[::each]:
            counts["changes"] += 1
            verdict, found = outcome(form, tampered(form.data, path, value))
            counts["wrong" if found else verdict] += 1
            wrong += [(path, value, found)] if found else []
        total += counts
        shown = (f"{counts[key]:>6} {key}" for key in ("values", "changes", "refused", "harmless", "wrong"))
        print(f"{name:<30}", *shown, flush=True)  # noqa: T201
        for line in wrong[:5]:
            print("   ", *line, flush=True)  # noqa: T201
    print("all", dict(total))  # noqa: T201


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1, sys.argv[2:])
