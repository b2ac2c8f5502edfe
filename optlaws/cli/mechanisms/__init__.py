"""Commands for what laws do in machines: followers, loaders, dwells, levers."""
