"""Jobs about laws: tables, fronts, families, an atlas."""
