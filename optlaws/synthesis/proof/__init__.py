"""Lower bounds that stand by themselves, and proofs that there is no law."""
