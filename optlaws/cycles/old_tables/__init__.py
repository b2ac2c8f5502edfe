"""Tables of old cams: files of controllers read back, divided into dwells and moves, and laws that better them."""
