"""Internals of `optlaws.cli` that tests look at by themselves."""

from optlaws.cli import app as app_of_cli
from optlaws.cli import show as output
from optlaws.cli.app import BAD_INPUT, COMMANDS, RETIRED, exit_code
from optlaws.cli.app import app as app_of_app
from optlaws.cli.options import Option, _head, _of_object, options, takes
from optlaws.cli.problem_options import options_of
from optlaws.cli.show import Answer, show
from optlaws.cli.synthesis.verify import verify
