"""The specification of a cycle: segments with units, a programme in numbers, and the conditions at joints."""
