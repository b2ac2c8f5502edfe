"""Jobs about elastic followers and the cams made for them."""
