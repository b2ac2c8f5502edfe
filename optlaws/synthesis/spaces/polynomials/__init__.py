"""Laws of eq. 8 with a polynomial Z."""
