"""The command `optlaws law`: a law of the catalogue, of a family, of a file or of a Z(k), with its constants."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from cyclopts import Parameter

import optlaws
from optlaws.cli.law_options import TABLE, read_law
from optlaws.cli.laws.catalogue import continuous
from optlaws.cli.options import AsJson, Plot, Whole, Written, save_picture, takes
from optlaws.cli.show import number, print_json, show, summary_table, table
from optlaws.errors import InputError, located


@takes(points=TABLE)
def law(
    name: str | None = None,
    /,
    *,
    alpha: float | None = None,
    peak_velocity: float | None = None,
    z: Annotated[str | None, Parameter(allow_leading_hyphen=True)] = None,
    order: Whole | None = None,
    at: list[float] | None = None,
    plot: Plot = None,
    csv: Written = None,
    samples: Whole | None = None,
    points: Mapping[str, Any],
    as_json: AsJson = False,
) -> None:
    """Show a law with its constants: of the catalogue, coded, of Savin's families, stored, or with a given Z.

    Parameters
    ----------
    name
        A name in any language or of a controller, a code such as "0317(1,5)", a member such as "III(7.2)", a JSON file
        of a law or of `optlaws solve --output`, or a file with a table of points (.csv, .txt, .tsv, .tab, .dat); or
        none, with --z and --order.
    alpha
        Member of the family I, II, III or IV.
    peak_velocity
        B of the member, in place of alpha.
    z
        In place of a name: coefficients of Z in ascending powers of k, separated by blanks, such as "0 -107.6 0 -21.8".
    order
        Number l of boundary conditions at each end of the law with this Z.
    at
        k in [0, 1] to give a, b, c, j and d at; may be repeated.
    plot
        Draw a, b, c and j into this file, PNG or SVG.
    csv
        Write k, a, b, c, j and d at equal steps of k to this file.
    samples
        How many lines for --csv; 201 unless given.
    """
    from optlaws.files import writing
    from optlaws.laws.values import LETTERS, SAMPLES, sizes, table_of_values

    if samples is not None and csv is None:
        raise InputError("--samples is the number of lines of --csv FILE: name the file")
    if name is None:
        motion_law = _polynomial(z, order)
        about = _facts(f"Z(k) of order {order}", motion_law)
    elif z is not None or order is not None:
        raise InputError(f"--z and --order make a law of their own: leave out {name!r}, or them")
    else:
        motion_law = read_law(name, alpha, peak_velocity, by="--alpha or --peak-velocity", points=points)
        about = _about(name, alpha, peak_velocity, motion_law)
    with located("--at"):
        values = [{"k": k, **{letter: getattr(motion_law, letter)(k) for letter in LETTERS}} for k in at or ()]
    if csv is not None:
        writing.write(csv, table_of_values(motion_law, name or about["name"], SAMPLES if samples is None else samples))
    save_picture(plot, motion_law)
    if as_json:
        print_json({**about, "at": values})
        return
    show(table(rows=_lines(about)), summary_table(motion_law.constants.summary(), "constant"))
    if values:
        known = (1.0, *sizes(motion_law))
        show(table(*values[0], rows=(map(number, row.values(), known) for row in values)))


def _polynomial(z: str | None, order: int | None) -> optlaws.MotionLaw:
    """The law from rest to rest with the given Z."""
    if z is None or order is None:
        raise InputError("name a law, or give --z and --order in its place")
    try:
        powers = [float(text) for text in z.replace(",", " ").split()]
    except ValueError as error:
        raise InputError(f"--z takes numbers separated by blanks: {error}") from None
    return optlaws.law_from_z(optlaws.BoundaryConditions.rest(order), powers)


def _about(name: str, alpha: float | None, B: float | None, motion_law: optlaws.MotionLaw) -> dict[str, Any]:
    from optlaws.laws.catalogue import reading

    family = reading.family_of(name)
    member = (optlaws.SavinFamily.of(family), alpha) if family is not None else reading.member(name)
    if member is not None:
        savin, given = member
        known = given if given is not None else savin.alphas(B=B)[0]
        constants = motion_law.constants.to_dict()
        about = {"name": f"Savin's {savin}", "alpha": known, "order": savin.order}
        return about | {"constants": constants, "law": motion_law.to_dict()}
    if reading.is_file(name) or reading.is_formula(name):
        return _facts(name if reading.is_formula(name) else f"the law in {name}", motion_law)
    return optlaws.catalogue[name].to_dict()


def _facts(name: str, motion_law: optlaws.MotionLaw) -> dict[str, Any]:
    from optlaws.laws.catalogue.entry import continuity_with_rest

    about = {"name": name, "constants": motion_law.constants.to_dict(), "law": motion_law.to_dict()}
    return about | {"continuity": continuity_with_rest(motion_law)}


def _lines(about: dict[str, Any]) -> list[tuple[str, str]]:
    if "alpha" in about:
        return [
            ("law", about["name"]),
            ("alpha", f"{about['alpha']:.10g}"),
            ("order l", str(about["order"])),
        ]
    lines = [("law", about["name"])]
    if "source" in about:
        names = "; ".join(f"{language}: {', '.join(some)}" for language, some in about["aliases"].items())
        lines += [("also", names), ("built", about["formula"]), ("source", about["source"])]
        if about["from_memory"]:
            lines.append(("", "the definition is from memory: compare it with the source"))
    return [*lines, ("continuous", continuous(about["continuity"]))]
