"""What cams are made of: motions by the cam's angle, Taylor arithmetic, and plane curves with all their derivatives."""
