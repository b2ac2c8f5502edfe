"""Commands that find optimal laws and check them: a single problem, a front, a study, a problem file."""
