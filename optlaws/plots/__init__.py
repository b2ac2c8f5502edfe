"""Pictures of laws, fronts, cycles, axes, cams and machines in one style, over matplotlib."""
