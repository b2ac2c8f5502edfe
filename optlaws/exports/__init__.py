"""Motions for controllers: files in their formats, and the motions executed from them."""
