"""What a motion drives: forces, torques and power, elastic loads."""
