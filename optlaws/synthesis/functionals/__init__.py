"""Constants from formulas: peaks, root mean squares, integrals and values of formulas of a motion."""
