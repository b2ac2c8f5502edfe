"""The greatest speed of a cycle under its limits, with the proof that none is greater."""
