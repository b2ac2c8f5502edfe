"""Laws that are polynomials between breaks: free ones, and those of eq. 8 with Z in B-splines."""
