"""`python -m optlaws` is the command `optlaws`."""

from optlaws.cli.commands import main

main()
