"""Cams that make an elastic follower's mass move by a given law."""
