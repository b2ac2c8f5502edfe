"""Jobs about machines that a law drives."""
