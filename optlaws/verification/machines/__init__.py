"""Linear machines in exact numbers and balls: transfer functions, responses, and constants of outputs."""
