"""The job "fastest": moves of problem files, their least times, and what less speed saves; tabled, drawn and proven."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from math import inf
from typing import Any

from optlaws.cycles.moves.fastest_move import AXES, FastestMove
from optlaws.cycles.moves.time_front import FrontOverTime, TimeFront, time_front
from optlaws.cycles.moves.timed_moves import VibratingFollower, fastest, fastest_moves
from optlaws.cycles.specification.limits import LIMITS_OF_MOVE
from optlaws.cycles.specification.segments import Move
from optlaws.entries.declared import Declared, FrozenTable, ValueOf, declared, entry, same
from optlaws.entries.value_types import Either, Listed, Measured, Text, is_list
from optlaws.errors import InfeasibleProblem, InputError, SolverFailure, located
from optlaws.files import writing
from optlaws.files.tables import Cell
from optlaws.jobs.cycle_entries import AxisEntries, drive_of
from optlaws.jobs.job_entries import ProblemFile, plain_name
from optlaws.laws.catalogue.catalogue import USUAL
from optlaws.mechanisms.drives.drive_train import Drive
from optlaws.motion.quantities import UNITS, Exact
from optlaws.numbers import NumberOrQuantity, Quantity, chop
from optlaws.plots.moves import fronts_figure, motion_figure, strokes_figure
from optlaws.results import Page, Results
from optlaws.sentences import quantity_name
from optlaws.shown.steps import step
from optlaws.studies.problem_entries import gap, problem, steady
from optlaws.synthesis.least_time.move_limits import RESIDUAL, RESIDUALS
from optlaws.synthesis.least_time.timed_move import AT_MOTOR
from optlaws.synthesis.problem.problem import PROBLEM, Problem
from optlaws.synthesis.status import Status

HEADINGS = (
    "move", "stroke", "least time, s", f"{USUAL}, s", "difference",
    "no law below, s", "best possible, s", "above it, %", "status", "binds",
)  # fmt: skip
_FEW = 7
_NOTHING = 1e-9  # of the vibration after the least time: what is rounding
_LITTLE = 5e-3  # of a value in the least time: a fall to less would be shown as one of 100 %
_PERCENT = 100.0
_STROKE = Measured("length", "angle")


@declared
class MoveEntries(Declared, title="a move"):
    """A move, or moves of several strokes, within the limits of a machine."""

    _: KW_ONLY
    name: str = entry(Text(), "What tables, pictures and files call it.", example="slide")
    stroke: Quantity | tuple[Quantity, ...] = entry(
        Either(_STROKE, Listed(_STROKE, least=2, most=1000), which=is_list),
        "How far it goes, or a list of up to 1,000 strokes.",
        example="100 mm",
    )
    limits: Mapping[str, Any] = entry(
        LIMITS_OF_MOVE, "Of the machine.", default=FrozenTable(), example={"velocity": "1 m/s", "jerk": "300 m/s^3"}
    )
    start_velocity: Quantity | None = same(Move, "start_velocity")
    end_velocity: Quantity | None = same(Move, "end_velocity")
    mechanism: Mapping[str, Any] | None = same(AxisEntries, "mechanism")
    drive: Mapping[str, Any] | None = same(AxisEntries, "drive")
    start: Quantity | None = entry(
        _STROKE, "Where the input of the mechanism begins, 0 unless given.", default=None, example="0 deg"
    )
    follower: VibratingFollower | None = entry(ValueOf(VibratingFollower), "What vibrates.", default=None)
    front: FrontOverTime | None = entry(
        ValueOf(FrontOverTime), "The quantity that is minimised over the time.", default=None
    )


@declared
class FastestProblemFile(ProblemFile, title="a problem file"):
    """The problem file of least times."""

    _: KW_ONLY
    move: tuple[MoveEntries, ...] = entry(
        Listed(ValueOf(MoveEntries), least=1, most=8, each="move", named=True), "Moves with their limits."
    )
    problem: Mapping[str, Any] | None = entry(
        PROBLEM, "The space of laws: `order`, 3 unless given, `basis`, `degree`, `windows`, ...", default=None
    )

    def _check(self) -> None:
        files = [plain_name(move.name) for move in self.move]
        if len(set(files)) < len(files) or {"about", "fastest"} & set(files):
            raise InputError(
                f"move: names must differ as files have them, and none is about or fastest: {', '.join(files)}"
            )


@dataclass(frozen=True)
class SoughtMove:
    """A move of a file with its least times, one for each stroke, and the fronts over its time."""

    name: str
    moves: tuple[FastestMove, ...]
    fronts: tuple[TimeFront, ...]


def sought(spec: FastestProblemFile) -> list[SoughtMove]:
    """The least times and the fronts of the moves of a file; an error names the move."""
    space = problem("problem", {"order": 3}, spec.problem or {})
    moves = []
    for move in spec.move:
        step(f"move {move.name}")
        try:
            with located(f"move {move.name}"):
                moves.append(_sought(move, space))
        except (InfeasibleProblem, SolverFailure) as error:
            raise InputError(error.args[0]) from error
    return moves


def _sought(move: MoveEntries, space: Problem) -> SoughtMove:
    """The least times and the fronts of one move."""
    given = arguments_of(move)
    if isinstance(move.stroke, tuple):
        if move.front is not None:
            raise InputError("front: it is that of one stroke: give the strokes to a move of another name")
        return SoughtMove(move.name, fastest_moves(space, strokes=move.stroke, **given), ())
    front = move.front
    names = () if front is None else front.minimise
    if move.follower is not None and "follower" not in given and not {*RESIDUALS} & {*names}:
        raise InputError(f'follower: give a limit or a front of the "{RESIDUAL}", or leave the follower out')
    quickest = fastest(space, stroke=move.stroke, **given)
    if front is None:
        return SoughtMove(move.name, (quickest,), ())
    extent = front.longest, front.points
    with located("front"):
        fronts = tuple(_front(quickest, move, name, given, extent) for name in front.minimise)
    return SoughtMove(move.name, (quickest,), fronts)


def _front(
    quickest: FastestMove, move: MoveEntries, minimise: str, given: dict[str, Any], extent: tuple[Any, int]
) -> TimeFront:
    """The front of a move; of a vibration, where no longest time is given, only as far as it leaves something."""
    step(f"move {move.name}: least {quantity_name(minimise)}")
    front = front_of(quickest, move, minimise, given, extent)
    calm = next((point.duration for point in front if point.value <= _NOTHING * front[0].value), inf)
    if extent[0] is None and minimise in RESIDUALS and front.durations[0] < calm < front.durations[-1]:
        return front_of(quickest, move, minimise, given, (Exact(calm, "s"), extent[1]))
    return front


def arguments_of(move: MoveEntries) -> dict[str, Any]:
    """The arguments of `fastest` besides a move's laws and its stroke.

    >>> arguments_of(MoveEntries(name="slide", stroke="100 mm", limits={"jerk": "300 m/s^3"}))["limits"]
    {'jerk': '300 m/s^3'}
    """
    given: dict[str, Any] = {name: getattr(move, name) for name in ("limits", "start_velocity", "end_velocity")}
    driven = drive_of(move.mechanism, move.drive)
    if isinstance(driven, Drive):
        given |= {"drive": driven, "start": move.start or 0.0}
    elif driven is not None:
        raise InputError(
            "drive: a move within torques has a motor and a mechanism, such as drive = { motor = { inertia = "
            "'3e-4 kg m^2', peak_torque = '6 N m' }, ratio = 20 }"
        )
    elif move.start is not None:
        raise InputError("start: it is the position of a mechanism: give the move its mechanism and drive")
    if move.follower is not None and any(name in move.limits for name in RESIDUALS):
        given["follower"] = move.follower
    return given


def front_of(
    quickest: FastestMove,
    move: MoveEntries,
    minimise: str,
    given: dict[str, Any],
    extent: tuple[NumberOrQuantity | None, int],
) -> TimeFront:
    """The front of a move over its time, up to the longest time; `given` holds its `arguments_of`."""
    machine: dict[str, Any] = {}
    if minimise in AT_MOTOR and "drive" in given:
        machine = {"drive": given["drive"], "start": given["start"]}
    elif minimise in RESIDUALS:
        machine = {"follower": move.follower}
    return time_front(quickest, minimise, longest=extent[0], points=extent[1], **machine)


def run(results: Results) -> None:
    """Put the tables, the page, the pictures, and laws with their proofs into results."""
    spec = FastestProblemFile.read(results.entries, results.file)
    results.title = spec.title
    moves = sought(spec)
    results.table("fastest", HEADINGS, [_line(each.name, move) for each in moves for move in each.moves])
    page = results.page("fastest").text(spec.text)
    for each in moves:
        _add_move(page, f"{spec.title}: {each.name}", each)
        for front in each.fronts:
            name = f"{plain_name(each.name)}_{plain_name(front.minimise)}"
            results.table(name, front.headings, _points(front))
    results.text("fastest.json", _json(results.about, moves))


def _line(name: str, move: FastestMove) -> list[Cell]:
    unit, factor = UNITS[AXES[move.unit]][0]
    # what is sought time by time is known to six digits, and where it is proven the bound is a millionth below
    below = move.none_below if move.status is Status.OPTIMAL else float(f"{move.none_below:.5g}")
    best = (
        move.best_possible
        if move.best_possible is None or move.least.move.torque is None
        else float(f"{move.best_possible:.5g}")
    )
    price = None if best is None else f"{_PERCENT * (move.duration / best - 1.0):.2f}"
    stroke = f"{factor * move.stroke:.9g} {unit}"
    usual = None if move.beside is None else move.beside.values[0]
    beside = [None, None] if usual is None else [usual.usual, usual.text]
    binding = ", ".join(map(quantity_name, move.binding))
    return [name, stroke, move.duration, *beside, below, best, price, move.status.value, binding]


def _add_move(page: Page, title: str, each: SoughtMove) -> None:
    """Put the tables and the pictures of one move on a page."""
    name, move = plain_name(each.name), each.moves[0]
    page.heading(each.name)
    if len(each.moves) > 1:
        page.picture(name, f"{each.name}: least time over the stroke", lambda: strokes_figure(each.moves, title))
        last = len(each.moves) - 1
        few = sorted({round(last * step / (_FEW - 1)) for step in range(_FEW)})
        page.table(HEADINGS[1:], [_line(each.name, each.moves[i])[1:] for i in few], digits=6)
        return
    page.picture(name, f"{each.name}: the fastest motion", lambda: motion_figure(move, title))
    page.facts(move.summary(), digits=6)
    if move.beside is not None:
        page.table(*move.beside.table, digits=6)
    if each.fronts:
        caption = f"{each.name}: the minimised quantity over the time"
        page.picture(f"{name}_front", caption, lambda: fronts_figure(each.fronts, title))
    for front in each.fronts:
        page.text(_in_words(front)).table(front.headings, _points(front), digits=6)


def _in_words(front: TimeFront) -> str:
    """The saving from a tenth more time, or from less where that leaves nothing, in words.

    Examples
    --------
    >>> from optlaws import Cycle, Rise
    >>> limits = {"velocity": "1 m/s", "jerk": "300 m/s^3"}
    >>> move = Cycle([Rise("100 mm")], period="0.3 s", advance="100 mm", limits=limits)
    >>> calm = move.front("residual acceleration", follower={"frequency": "12 Hz"}, points=9, longest="0.4 s")
    >>> _in_words(calm)
    'The least residual acceleration falls to next to nothing in a time 7 % longer than the least. Every point is ...'
    """
    first, last = front[0], front[-1]
    nothing = [point for point in front if chop(point.value, first.value, _LITTLE) == 0.0]
    tenth = [point for point in front if point.duration >= 1.1 * first.duration]
    later = min([*nothing[:1], *tenth[:1], last], key=lambda point: point.duration)
    more = later.duration / first.duration - 1.0
    proven = "Every point is proven" if front.status is Status.OPTIMAL else "The bounds hold for all laws of the space"
    longer = f"in a time {_PERCENT * more:.0f} % longer than the least"
    if chop(later.value, first.value, _LITTLE) == 0.0:
        share = f"falls to next to nothing {longer}" if first.value else "is 0 in the least time already"
    else:
        share = f"falls by {_PERCENT * (1.0 - later.value / first.value):.0f} % {longer}"
    return f"The least {quantity_name(front.minimise)} {share}. {proven}."


def _points(front: TimeFront) -> list[list[Cell]]:
    rows: list[list[Cell]] = []
    for point, solution in zip(front, front.solutions, strict=True):
        # what of a search or of a phase plane differs between machines is not shown
        sure = solution.status is Status.OPTIMAL
        bound = point.lower_bound if sure else float(f"{point.lower_bound:.3g}")
        value = chop(point.value, front[0].value, _NOTHING)
        apart = gap(solution) if sure and value else None
        rows.append([point.duration, value, bound, apart, solution.status.value])
    return rows


def _json(about: str, moves: Sequence[SoughtMove]) -> str:
    """Laws and proofs for `optlaws verify`, a line for each least time or front."""
    head = json.dumps({"about": f"{about}; {writing.MARK}"})[:-1]
    parts = []
    for each in moves:
        kind, values = ("fronts", each.fronts) if each.fronts else ("moves", each.moves)
        lines = ",\n".join(json.dumps(steady(value.to_dict())) for value in values)
        parts.append(f"{json.dumps(each.name)}: {{{json.dumps(kind)}: [\n{lines}\n]}}")
    return f"{head},\n" + ",\n".join(parts) + "}\n"
