"""Tables of old cams: files of controllers are read, divided into dwells and moves, and improved."""
