"""The ledger: every printed number, formula, figure and claim of the papers, each with a verdict that is computed."""
