"""Ways of answering the rounds in which a program is solved: Newton on contacts, vertices, IPOPT on points."""
