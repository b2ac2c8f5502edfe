"""Functions for controllers that choose a law while they run: proven fronts, and moves by pieces in closed form."""
