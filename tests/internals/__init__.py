"""What tests reach into, a file for each room: a module that moves is followed here alone."""
