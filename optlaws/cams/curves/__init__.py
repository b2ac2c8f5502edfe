"""Curves of cams: motions by the cam's angle, plane curves, extremes; splines, chords, arcs and files that cut them."""
