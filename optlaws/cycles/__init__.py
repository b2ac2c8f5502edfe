"""Whole cycles of machines in physical units: segments, their laws, peaks, drives, and what is optimal of it all."""
