"""Jobs about inertial loaders."""
