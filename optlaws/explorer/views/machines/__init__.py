"""The views of driven mechanisms: machines with their drives, and moves in their least times."""
