"""Single moves in problem files: their least times, and what less speed would save."""
