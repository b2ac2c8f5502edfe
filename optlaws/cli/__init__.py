"""The command `optlaws`, one file for each group of its commands."""

from optlaws.cli.commands import exit_code, main

__all__ = ["exit_code", "main"]
