"""Tight lower bounds with D: boxes that hold all laws are shrunk until none is left."""
