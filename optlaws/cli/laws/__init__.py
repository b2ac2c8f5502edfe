"""Commands that show laws: the catalogue, its laws, constants of a given law."""
