"""Savin's families of laws, for every u, with their members by any peak constant."""
