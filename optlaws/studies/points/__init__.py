"""What a study asks: its file, what varies, and its points in order."""
