"""The command `optlaws law`: a law of the catalogue, of a family, of a file or of a Z(k), with its constants."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.law_options import TABLE, named, numbers_in
from optlaws.cli.options import Whole, Written, takes
from optlaws.cli.show import Answer
from optlaws.errors import InputError, located
from optlaws.shown.report import PlainReport, Report, ReportTable
from optlaws.shown.summary import Row, Summary


@takes("Draw a, b, c and j into this file, PNG or SVG.", points=TABLE)
def law(
    name: str | None = None,
    /,
    *,
    alpha: float | None = None,
    peak_velocity: float | None = None,
    z: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    order: Whole | None = None,
    at: list[float] | None = None,
    csv: Written = None,
    samples: Whole | None = None,
    points: Mapping[str, Any],
) -> Answer:
    """Show a law with its constants: of the catalogue, coded, of Savin's families, stored, or with a given Z.

    Parameters
    ----------
    name
        A name in any language or of a controller, a code such as "0317(1,5)", a member such as "III(7.2)", a JSON file
        of a law or of `optlaws solve --output`, or a file with a table of points (.csv, .txt, .tsv, .tab, .dat); or
        none, with --z and --order.
    alpha
        Member of the family I, II, III or IV; a negative one as --alpha=-5.
    peak_velocity
        B of the member, in place of --alpha.
    z
        In place of a name: coefficients of Z in ascending powers of k, separated by blanks, such as "0 -107.6 0 -21.8".
    order
        Number l of boundary conditions at each end of the law with this Z.
    at
        k in [0, 1] to give a, b, c, j and d at; may be repeated.
    csv
        Write k, a, b, c, j and d at equal steps of k to this file.
    samples
        How many lines for --csv; 201 unless given.
    """
    import numpy as np

    from optlaws.files import writing
    from optlaws.laws.catalogue import reading
    from optlaws.laws.report import LETTERS, SAMPLES, table_of_values, values

    if samples is not None and csv is None:
        raise InputError("--samples is the number of lines of --csv FILE: name the file")
    if name is None:
        motion_law = _polynomial(z, order)
    elif z is not None or order is not None:
        raise InputError(f"--z and --order make a law of their own: leave out {name!r}, or them")
    else:
        name = named(name, alpha, peak_velocity, "--alpha or --peak-velocity")
        motion_law = reading.read_law(name, **points)
    report = _report(name, order, motion_law)
    with located("--at"):
        exact = [{"k": k, **{letter: getattr(motion_law, letter)(k) for letter in LETTERS}} for k in at or ()]
    if csv is not None:
        title = name or f"Z(k) of order {order}"
        writing.write(csv, table_of_values(motion_law, title, SAMPLES if samples is None else samples))
    shown: list[Summary | ReportTable] = [report.facts]
    if at:
        rows = zip(at, *values(motion_law, np.array(at)), strict=True)
        shown.append(ReportTable(["k", *LETTERS], [[f"{value:.10g}" for value in row] for row in rows]))
    return Answer(lambda: shown, lambda: {**report.data, "at": exact}, motion_law.plot)


def _polynomial(z: str | None, order: int | None) -> optlaws.MotionLaw:
    """The law from rest to rest with the given Z."""
    if z is None or order is None:
        raise InputError("name a law, or give --z and --order in its place")
    powers = numbers_in(z, "--z takes numbers separated by blanks")
    return optlaws.law_from_z(optlaws.BoundaryConditions.rest(order), powers)


def _report(name: str | None, order: int | None, motion_law: optlaws.MotionLaw) -> Report:
    """The report of a law under its name, or without one under its order."""
    from optlaws.laws.catalogue import reading
    from optlaws.laws.catalogue.entry import continuity_row, continuity_with_rest

    report, member = motion_law.report(), None if name is None else reading.member(name)
    if member is not None:
        family, alpha = member
        data = {"name": f"Savin's {family}", "alpha": alpha, "order": family.order, **report.data}
        rows = [Row("law", data["name"]), Row("alpha", alpha), Row("order l", family.order)]
    elif name is not None and not reading.is_file(name) and not reading.is_formula(name):
        return optlaws.catalogue[name].report()
    else:
        of_file = name if name is None or reading.is_formula(name) else f"the law in {name}"
        continuity = continuity_with_rest(motion_law)
        data = {"name": of_file or f"Z(k) of order {order}", **report.data, "continuity": continuity}
        rows = [Row("law", data["name"]), continuity_row(continuity)]
    return PlainReport(Summary([*rows, *report.facts], at="k"), (), report.panels, lambda: data)
