"""Construction of laws: by their shape, from other laws, by the multiplier method."""
