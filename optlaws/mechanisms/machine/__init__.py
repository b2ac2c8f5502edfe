"""Machines: linear models of any size that a law drives, their exact responses and their constants in optimisation."""
