"""Laws of several axes on one clock, optimised together with the instants at which they wait for each other."""
