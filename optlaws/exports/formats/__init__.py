"""Formats of controllers, a file for each manufacturer or language, and the common parts of tables and programs."""
