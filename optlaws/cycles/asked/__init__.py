"""What is asked of a cycle: quantities with units, segments, a programme in numbers, and what holds at joints."""
