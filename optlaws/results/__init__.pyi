# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.files.tables import Cell as Cell
from optlaws.files.writing import MARK as MARK
from optlaws.results.printed import MISPRINT as MISPRINT
from optlaws.results.printed import ON_GRID as ON_GRID
from optlaws.results.printed import REPRODUCED as REPRODUCED
from optlaws.results.printed import PrintedNumber as PrintedNumber
from optlaws.results.printed import compared as compared
from optlaws.results.printed import number as number
from optlaws.results.printed import rows as rows
from optlaws.results.printed import same_digits as same_digits
from optlaws.results.results import Entries as Entries
from optlaws.results.results import Page as Page
from optlaws.results.results import Results as Results
from optlaws.results.results import read as read
from optlaws.suggest import unknown_key as unknown_key

__all__ = [
    "MARK",
    "MISPRINT",
    "ON_GRID",
    "REPRODUCED",
    "Cell",
    "Entries",
    "Page",
    "PrintedNumber",
    "Results",
    "compared",
    "number",
    "read",
    "rows",
    "same_digits",
    "unknown_key",
]
