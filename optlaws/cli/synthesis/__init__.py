"""Commands that look for optimal laws and check them: one problem, a front, a study, a problem file."""
