"""What cuts a cam: splines, chords and arcs within a tolerance, and the files that hold them."""
