"""Functions for controllers that choose a law while they run: proven fronts."""
