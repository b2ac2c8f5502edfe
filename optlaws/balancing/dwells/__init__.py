"""Balancing cam mechanisms for motions with dwells, of types I, II and III."""
