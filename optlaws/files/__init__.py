"""Files in and out: what comes in is read whole and checked, what goes out is written whole or not at all."""
