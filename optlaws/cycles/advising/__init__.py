"""Which law a motion should have: standard and optimal laws side by side, the front between, and a rule that picks."""
