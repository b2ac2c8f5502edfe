"""`python -m optlaws` is the command `optlaws`."""

from optlaws.cli.app import main

main()
