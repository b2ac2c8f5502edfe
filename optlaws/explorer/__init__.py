"""The explorer in the browser: its server, which calls the public functions, and its page."""
