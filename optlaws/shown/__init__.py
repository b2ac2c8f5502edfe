"""Progress bars for long work, and small HTML pages of values in notebooks."""
