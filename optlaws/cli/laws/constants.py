"""The command `optlaws constants`: the peaks of a law whose Z(k) is given."""

from __future__ import annotations

from typing import Annotated

from cyclopts import Parameter

import optlaws
from optlaws.cli.options import AsJson, Plot, Whole, check_files, save_picture
from optlaws.cli.show import constants_table, print_json, show
from optlaws.errors import InputError


def constants(
    *,
    z: Annotated[str, Parameter(allow_leading_hyphen=True)],
    order: Whole,
    plot: Plot = None,
    as_json: AsJson = False,
) -> None:
    """Peak constants of the rest-to-rest law with a given Z(k).

    Parameters
    ----------
    z
        Coefficients of Z in ascending powers of k, separated by blanks: "148.4156 -553.8533 771.0667 -514.0444".
    order
        Number l of boundary conditions at each end.
    plot
        Draw a, b, c and j of the law into this file, PNG or SVG.
    as_json
        Print one JSON object on stdout and nothing else.
    """
    check_files(plot=plot)
    try:
        numbers = [float(text) for text in z.replace(",", " ").split()]
    except ValueError as error:
        raise InputError(f"--z takes numbers separated by blanks: {error}") from None
    law = optlaws.law_from_z(optlaws.BoundaryConditions.rest(order), numbers)
    peaks = law.constants
    if plot is not None:
        save_picture(plot, law)
    if as_json:
        print_json(peaks.to_dict(rms=False))
    else:
        show(constants_table(peaks))
