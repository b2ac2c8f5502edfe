"""Followers of disc cams: rollers and flat faces that slide or swing."""
