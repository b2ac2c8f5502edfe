"""Rigorous enclosures: interval arrays, Taylor jets over them, extremes by branch and bound, integrals."""
