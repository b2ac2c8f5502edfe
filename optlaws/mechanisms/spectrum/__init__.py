"""Followers of every frequency: vibration left behind, response spectra, robust laws."""
