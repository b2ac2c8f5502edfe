"""How a program is solved: few points by IPOPT, then Newton on the exact contacts."""
