"""The command `optlaws`: one file a command, and the file's name is the command's."""

from optlaws.cli.app import exit_code, main

__all__ = ["exit_code", "main"]
