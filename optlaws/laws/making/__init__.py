"""Laws made: by their shape, from other laws, by the multiplier method."""
