"""Problem files and the jobs they name."""
