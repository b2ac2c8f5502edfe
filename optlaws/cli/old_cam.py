"""`optlaws cycle` for the table of an old cam: its moves, better ones, files for controllers, a picture."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from optlaws.cli import options
from optlaws.cli.show import busy, print_json, show, table
from optlaws.errors import InputError

if TYPE_CHECKING:
    from optlaws.cycles.cycle import Cycle
    from optlaws.cycles.old_tables.better_moves import MoveGain
    from optlaws.cycles.old_tables.table import OldTable


def old_cam(
    file: Path,
    how: Mapping[str, Any],
    *,
    speed: str | None,
    modernise: str | None,
    export: str | None,
    save: Path | None,
    out: Path | None,
    plot: Path | None,
    as_json: bool,
) -> None:
    """Answer for the table of an old cam, read `how` the options say."""
    from optlaws.cycles.old_tables.table import read_cycle_table
    from optlaws.exports.format import format_of
    from optlaws.motion.quantities import positive_quantity

    if speed is not None:
        positive_quantity(speed, "angular velocity", "--speed")
    if save is not None and save.suffix != ".toml":
        raise InputError(f"--save takes a problem file, whose name ends in .toml, got {save}")
    chosen = None if export is None else format_of(export)
    with busy(f"{file}"):
        old = read_cycle_table(file, **how)
        new = None if modernise is None else old.bettered(_tolerance(modernise, old))
    latest = new or old
    written: dict[str, str] = {}
    if chosen is not None:
        exported = _cycle(latest, speed).export(chosen.name)
        place = (out or Path()) / f"{file.stem}_{chosen.name}{chosen.extension}"
        options.check_file(None, place)
    if save is not None:
        written["saved"] = str(_save(latest, save, file, speed))
    if chosen is not None:
        written["exported"] = str(exported.write(place))
    if plot is not None:
        options.save_picture(plot, old, new=new)
        written["picture"] = str(plot)
    if as_json:
        print_json(_facts(file, old, new) | written)
        return
    _show(old, new)
    if chosen is not None:
        show(str(exported))
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
    from optlaws.files.writing import MARK, write
    from optlaws.laws import MotionLaw

    stretches = []
    for number, part in enumerate(latest.stretches, start=1):
        if isinstance(part.law, MotionLaw):
            beside = place.with_name(f"{place.stem}_{number}_{part.kind}.json")
            options.save(beside, {"law": part.law.to_dict()})
            stretches.append(replace(part, law=str(beside)))
        else:
            stretches.append(part)
    cycle = _cycle(replace(latest, stretches=tuple(stretches)), speed)
    return write(place, f"# from {source.name}; {MARK}\n{cycle.to_toml(f'The cam of {source.name}', axis='cam')}")


def _show(old: OldTable, new: OldTable | None) -> None:
    from optlaws.cycles.old_tables.better_moves import law_of_move, nothing_to_better
    from optlaws.motion.quantities import QUANTITIES

    show(f"{old.layout}, {len(old.places)} points", str(old))
    if new is None:
        return
    units = (f"{old.unit}/{old.master}{power}" for power in ("", "²", "³"))
    peaks = (f"{name}, {unit}" for name, unit in zip(QUANTITIES[1:4], units, strict=True))
    rows = (
        (
            gain.kind,
            f"{gain.start:g}",
            f"{gain.stop:g}",
            *map(partial(_change, gain), (1, 2, 3)),
            f"{gain.deviation:.3g}",
        )
        for gain in new.gains(old)
    )
    show(table("move", "from", "to", *peaks, f"off by, {old.unit}", rows=rows))
    for part, was in zip(new.moves, old.moves, strict=True):
        if part.law is was.law:
            what = nothing_to_better(law_of_move(part))
            why = f"it is {what}" if what else "none of degree 15 so near has less acceleration"
            show(f"the {part.kind} from {part.start:g} keeps its law: {why}")


def _change(gain: MoveGain, nu: int) -> str:
    share = gain.share(nu)
    change = "" if share != share else f" ({100.0 * share:+.1f} %)"  # noqa: PLR0124 - nan
    return f"{gain.old[nu - 1]:.4g} -> {gain.new[nu - 1]:.4g}{change}"


def _facts(file: Path, old: OldTable, new: OldTable | None) -> dict[str, Any]:
    from optlaws.numbers import bounded

    stretches = [
        {
            **{name: getattr(part, name) for name in ("kind", "start", "stop", "low", "high")},
            "law": part.law if part.law is None or isinstance(part.law, str) else part.law.to_dict(),
            "nearest": part.nearest or None,
            "distance": part.distance if part.nearest else None,
        }
        for part in (new or old).stretches
    ]
    facts = {
        "file": str(file),
        "layout": old.layout,
        "points": len(old.places),
        **{name: getattr(old, name) for name in ("unit", "master", "room", "scatter", "seam")},
        "stretches": stretches,
    }
    gains = () if new is None else new.gains(old)
    peaks = ({"old": list(map(bounded, gain.old)), "new": list(map(bounded, gain.new))} for gain in gains)
    rows = [gain._asdict() | finite for gain, finite in zip(gains, peaks, strict=True)]
    return facts if new is None else facts | {"gains": rows}
