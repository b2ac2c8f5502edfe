"""The drive of a motion: forces, torques and power, and elastic loads."""
