"""Whole cycles of machines in physical units: segments, their laws, peaks, drives, and optimal cycles."""
