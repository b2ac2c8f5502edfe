"""The cams of mechanisms that balance: inertial loaders, dwell mechanisms and torsion levers, in machine units."""
