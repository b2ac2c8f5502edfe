# made by tests/contracts/faces.py from the table in __init__.py
from optlaws.mechanisms.dwell.choice import least_dwell as least_dwell

__all__ = [
    "least_dwell",
]
