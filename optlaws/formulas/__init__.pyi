# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.formulas.arithmetic import NUMPY as NUMPY
from optlaws.formulas.arithmetic import evaluate as evaluate
from optlaws.formulas.reading import read as read
from optlaws.formulas.tree import Formula as Formula

__all__ = [
    "NUMPY",
    "Formula",
    "evaluate",
    "read",
]
