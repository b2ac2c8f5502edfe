"""Single moves in problem files: their least times, and the savings of longer times."""
