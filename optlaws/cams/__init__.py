"""Cams: pitch curves, profiles and cutter paths as functions of the cam's angle, with enclosed extremes."""
