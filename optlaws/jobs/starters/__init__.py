"""Problem files to begin with: commented, and filled in with a person's own numbers."""
