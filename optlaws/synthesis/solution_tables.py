"""Many solutions as a table or a dataset: what varies, the numbers and the statuses."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from optlaws.extras import needed
from optlaws.synthesis.arrays.problems import ProblemArray

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

NUMBERS = ("objective", "lower_bound", "gap", "B", "C", "D", "J", "rms_c")

Columns = Mapping[str, NDArray[Any]]


def as_pandas(problems: ProblemArray, columns: Columns) -> pd.DataFrame:
    """A row for each problem: what varies, and columns of the problems' shape."""
    needed("pandas", "to_pandas")
    import pandas as pd

    varied = {name: arrays[0].reshape(-1) for name, arrays in problems.varied.items() if len(arrays) == 1}
    named = {_asked(name): values for name, values in varied.items()}
    return pd.DataFrame({**named, **{name: values.reshape(-1) for name, values in columns.items()}})


def as_xarray(problems: ProblemArray, columns: Columns, longer: Mapping[str, tuple[str, NDArray[Any]]]) -> xr.Dataset:
    """A dataset over the axes of the problems, of which one along which one entry of numbers varies has its name.

    Parameters
    ----------
    problems, columns
        The problems, and values of their shape.
    longer
        Values with one axis more, each with that axis's name.
    """
    needed("xarray", "to_xarray")
    import xarray as xr

    dims, coords = _axes(problems)
    variables: dict[str, Any] = {name: (dims, values) for name, values in columns.items()}
    variables |= {name: ([*dims, last], values) for name, (last, values) in longer.items()}
    return xr.Dataset(variables, coords)


def _axes(problems: ProblemArray) -> tuple[list[str], dict[str, Any]]:
    """Names of the problems' axes, and the values along those that have one entry of numbers alone."""
    dims = [f"axis {i}" for i in range(len(problems.shape))]
    coords = {}
    for name, arrays in problems.varied.items():
        strides = [i for i, step in enumerate(arrays[0].strides) if step and problems.shape[i] > 1]
        alone = len(arrays) == 1 and len(strides) == 1 and arrays[0].dtype.kind in "fiu"
        if alone and dims[strides[0]].startswith("axis "):
            dims[strides[0]] = _asked(name)
            coords[_asked(name)] = np.moveaxis(arrays[0], strides[0], 0).reshape(problems.shape[strides[0]], -1)[:, 0]
    return dims, coords


def _asked(name: str) -> str:
    """What a column of an entry's values is called beside the numbers of the laws."""
    return f"{name} asked" if name in NUMBERS else name
