"""What a cam and its follower bear: contact forces, springs, pressures, and the torque at the shaft."""
