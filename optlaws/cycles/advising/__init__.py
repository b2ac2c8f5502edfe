"""Advice on the law of a motion: standard and optimal laws side by side, the front between, and a rule that picks."""
