"""Motions in a phase plane: what the whole time says of their torque, and the value of one of them."""
