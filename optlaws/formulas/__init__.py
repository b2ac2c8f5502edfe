"""Formulas as text: read into trees, never executed; evaluated by any arithmetic, differentiated, judged by rules."""
