"""Questions to machines beside responses: laws that make an output move as it should, spectra over parameters."""
