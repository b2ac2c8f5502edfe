"""Laws of several axes on one clock, looked for together with the instants at which they wait for each other."""
