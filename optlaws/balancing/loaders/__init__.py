"""Inertial loaders: their laws, their limits, and executive laws made for their sake."""
