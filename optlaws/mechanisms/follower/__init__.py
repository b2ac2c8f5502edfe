"""The elastic follower: what a cam makes of the mass that it drives, and cams made for its mass."""
