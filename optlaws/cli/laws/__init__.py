"""Commands that show laws and what they do in machines: the catalogue, followers, cycles, loaders, dwells, levers."""
