"""`optlaws cycle` for the table of an old cam: its moves, better ones, files for controllers, a picture."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cyclopts import Parameter

from optlaws.cli.options import Plot, TableOptions, check_files, save_figure
from optlaws.cli.show import busy, print_json, show, table
from optlaws.echo import shortened
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.old_tables.table import OldTable


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class OldCamOptions:
    """The table of an old cam in place of a problem file.

    Parameters
    ----------
    unit
        Of its positions, such as mm, or 0.01mm where numbers count these; what the file says, or mm, unless given.
    master
        Of its master: deg, rad, turn, s, or 0.1deg; what the file says, or what its length lets suppose, unless given.
    cam
        Which cam of a file with several.
    speed
        Of the master, such as "200 rpm"; what the file says unless given. --save and --export need it where the master
        is an angle.
    modernise
        How far better laws may be off the old ones, such as 0.05mm: the laws of least acceleration within it.
    export
        A format of `optlaws export --list`: the cycle is written in it, modernised where --modernise is given.
    save
        Write the cycle as a problem file (.toml), its laws beside it.
    """

    unit: str | None = None
    master: str | None = None
    cam: str | None = None
    speed: str | None = None
    modernise: str | None = None
    export: str | None = None
    save: Path | None = None


NO_OLD_CAM = OldCamOptions()


def old_cam(
    file: Path, options: OldCamOptions, points: TableOptions, out: Path | None, plot: Plot, *, as_json: bool
) -> None:
    """Answer for the table of an old cam."""
    from optlaws.cycles.old_tables.table import read_cycle_table
    from optlaws.exports.format import format_of
    from optlaws.motion.quantities import positive_quantity

    check_files(options.save, plot=plot)
    if options.speed is not None:
        positive_quantity(options.speed, "angular velocity", "--speed")
    if options.save is not None and options.save.suffix != ".toml":
        raise InputError(f"--save takes a problem file, whose name ends in .toml, got {options.save}")
    chosen = None if options.export is None else format_of(options.export)
    with busy(f"{file}"):
        old = read_cycle_table(
            file,
            tolerance=points.tolerance,
            columns=None if points.columns is None else points.columns.split(","),
            unit=options.unit,
            master=options.master,
            cam=options.cam,
        )
        new = None if options.modernise is None else old.bettered(_tolerance(options.modernise, old))
    latest = new or old
    written: dict[str, str] = {}
    if chosen is not None:
        export = _cycle(latest, options.speed).export(chosen.name)
        place = (out or Path()) / f"{file.stem}_{chosen.name}{chosen.extension}"
        check_files(place)
    if options.save is not None:
        written["saved"] = str(_save(latest, options.save, file, options.speed))
    if chosen is not None:
        written["exported"] = str(export.write(place))
    if plot is not None:
        written["picture"] = str(_draw(old, new, plot))
    if as_json:
        print_json(_facts(file, old, new) | written)
        return
    _show(old, new)
    if chosen is not None:
        show(str(export))
    show(*(f"{what}: {place}" for what, place in written.items()))


def _tolerance(text: str, old: OldTable) -> float:
    """A tolerance in units of the table; a bare number is in these."""
    from optlaws.motion.quantities import either

    try:
        return float(text)
    except ValueError:
        dimension, size = either(f"1 {old.unit}", ("length", "angle"), "unit")
        return either(text, (dimension,), "--modernise")[1] / size


def _cycle(old: OldTable, speed: str | None) -> Cycle:
    if speed is None and old.rate is None and old.master not in {"s", "ms"}:
        raise InputError("--save and --export need the speed of the master, such as --speed 200rpm: the file has none")
    try:
        return old.cycle(speed=speed)
    except InputError as error:
        raise InputError(
            f"{error}; segments are the stretches of the table, as they are listed without --save"
        ) from None


def _save(latest: OldTable, place: Path, source: Path, speed: str | None) -> Path:
    """The problem file of a cycle; laws that have no name as files beside it."""
    from optlaws.cli.options import save
    from optlaws.files.writing import MARK, write
    from optlaws.laws import MotionLaw

    stretches = []
    for number, part in enumerate(latest.stretches, start=1):
        if isinstance(part.law, MotionLaw):
            beside = place.with_name(f"{place.stem}_{number}_{part.kind}.json")
            save(beside, {"law": part.law.to_dict()})
            stretches.append(replace(part, law=str(beside)))
        else:
            stretches.append(part)
    cycle = _cycle(replace(latest, stretches=tuple(stretches)), speed)
    return write(place, f"# from {source.name}; {MARK}\n{cycle.to_toml(f'The cam of {source.name}', axis='cam')}")


def _draw(old: OldTable, new: OldTable | None, place: Path) -> Path:
    from optlaws.plots.style import plot_style

    with plot_style():
        save_figure(place, old.plot(new=new)[0].get_figure(root=True))
    return place


def _show(old: OldTable, new: OldTable | None) -> None:
    from optlaws.cycles.old_tables.better_moves import law_of_move, nothing_to_better

    show(f"{old.layout}, {len(old.places)} points", str(old))
    if new is None:
        return
    units = [f"{old.unit}/{old.master}{power}" for power in ("", "²", "³")]
    headings = ["move", "from", "to"]
    headings += [f"{name}, {unit}" for name, unit in zip(("velocity", "acceleration", "jerk"), units, strict=True)]
    rows = [
        (
            gain.kind,
            f"{gain.start:g}",
            f"{gain.stop:g}",
            *(_change(gain, nu) for nu in (1, 2, 3)),
            f"{gain.deviation:.3g}",
        )
        for gain in new.gains(old)
    ]
    show(table(*headings, f"off by, {old.unit}", rows=rows))
    same = [part for part, was in zip(new.moves, old.moves, strict=True) if part.law is was.law]
    for part in same:
        what = nothing_to_better(law_of_move(part))
        why = f"it is {what}" if what else "none of degree 15 so near has less acceleration"
        show(f"the {part.kind} from {part.start:g} keeps its law: {why}")


def _change(gain: Any, nu: int) -> str:
    share = gain.share(nu)
    change = "" if share != share else f" ({100.0 * share:+.1f} %)"  # noqa: PLR0124 - nan
    return f"{gain.old[nu - 1]:.4g} -> {gain.new[nu - 1]:.4g}{change}"


def _facts(file: Path, old: OldTable, new: OldTable | None) -> dict[str, Any]:
    from optlaws.numbers import bounded

    latest = new or old
    facts: dict[str, Any] = {
        "file": str(file),
        "layout": old.layout,
        "points": len(old.places),
        "unit": old.unit,
        "master": old.master,
        "room": old.room,
        "scatter": old.scatter,
        "seam": old.seam,
        "stretches": [
            {
                "kind": part.kind,
                "start": part.start,
                "stop": part.stop,
                "low": part.low,
                "high": part.high,
                "law": part.law if part.law is None or isinstance(part.law, str) else part.law.to_dict(),
                "nearest": part.nearest or None,
                "distance": part.distance if part.nearest else None,
            }
            for part in latest.stretches
        ],
    }
    if new is not None:
        facts["gains"] = [
            {
                "kind": gain.kind,
                "start": gain.start,
                "stop": gain.stop,
                "old": list(map(bounded, gain.old)),
                "new": list(map(bounded, gain.new)),
                "deviation": gain.deviation,
            }
            for gain in new.gains(old)
        ]
    return facts


def refuse_options(options: OldCamOptions, points: TableOptions) -> None:
    """Refuse options for the table of an old cam where a problem file is given."""
    given = {**vars(options), **vars(points)}
    for name, value in given.items():
        if value is not None:
            raise InputError(f"--{name} is of the table of an old cam, got {shortened(value)} with a problem file")
