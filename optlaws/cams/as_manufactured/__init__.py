"""Cams as they are made: their points rounded, splined and run against the follower."""
