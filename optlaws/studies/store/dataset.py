"""The rows of a study over its dimensions, for xarray."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from optlaws.studies.points.points import Points
from optlaws.studies.solving.solving import Row
from optlaws.studies.store.table import NUMBERS, column, kind

if TYPE_CHECKING:
    import xarray as xr


def dataset(rows: Iterable[Row], points: Points, about: Mapping[str, Any]) -> xr.Dataset:
    """One dimension for each factor of the product; one variable for each number, and the status.

    What varies alone is a coordinate of its dimension; what varies together shares one, "together 1" or "sample 1".
    """
    import xarray as xr

    numbers: dict[str, NDArray[np.float64]] = {name: np.full(len(points), np.nan) for name in NUMBERS}
    status = np.full(len(points), "", dtype=object)
    for row in rows:
        index = row["index"]
        status[index] = row["status"]
        for name, found in numbers.items():
            if row[name] is not None:
                found[index] = row[name]
    dimensions = [column(axis.label) for axis in points.axes]
    coordinates = {}
    for axis, dimension in zip(points.axes, dimensions, strict=True):
        for name, values in zip(axis.names, axis.columns, strict=True):
            plain = kind(axis, name) != "text"
            listed = [value if plain or isinstance(value, str) else json.dumps(value) for value in values]
            coordinates[column(name)] = (dimension, listed)
    variables = {name: (dimensions, values.reshape(points.shape)) for name, values in numbers.items()}
    whole = xr.Dataset({**variables, "status": (dimensions, status.reshape(points.shape))}, coordinates)
    whole.attrs = {name: json.dumps(value) if isinstance(value, dict) else value for name, value in about.items()}
    return whole
