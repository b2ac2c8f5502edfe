"""Formats of controllers, a file for each manufacturer or language, and what tables and programs share."""
