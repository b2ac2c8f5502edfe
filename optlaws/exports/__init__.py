"""Motions for controllers: files in their formats, and what they will run when they interpolate them."""
