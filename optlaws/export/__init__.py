"""What leaves the library: files and tables."""
