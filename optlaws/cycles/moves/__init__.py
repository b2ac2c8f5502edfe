"""Single moves in machine units: the least time within the limits of a machine."""
