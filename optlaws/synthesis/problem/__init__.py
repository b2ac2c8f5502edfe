"""What is asked: constants, their ranges and mixtures, windows; the problem made of them."""
