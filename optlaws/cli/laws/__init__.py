"""Commands that show laws and their effect in machines: catalogue, followers, cycles, loaders, dwells, levers."""
