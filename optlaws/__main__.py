"""`python -m optlaws` is the command `optlaws`."""

from optlaws.cli import main

main()
