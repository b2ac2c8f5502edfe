"""The views of what moves a mechanism: machines with their drives, and moves in their least times."""
