"""Where the points of a study are solved: in this process, in watched ones, on a cluster."""
