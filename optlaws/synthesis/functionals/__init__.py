"""Constants made of formulas: peaks, root mean squares, integrals and values of what a formula says of a motion."""
