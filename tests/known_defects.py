"""What the tests ask and the engine does not yet do: each must fail, so that a cure is noticed and the line goes.

A line names a part of a test's id and says what is missing.
"""

KNOWN_DEFECTS: dict[str, str] = {}
