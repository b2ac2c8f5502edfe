"""Commands for mechanisms that balance others."""
