"""Entries of the axes of a cycle: segments, mechanisms and drives, and the pages of the drives."""
