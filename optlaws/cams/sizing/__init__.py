"""Springs and flywheels of cams, sized by their forces over the turn."""
