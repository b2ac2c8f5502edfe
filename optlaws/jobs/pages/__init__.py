"""What pages of results have in common."""
