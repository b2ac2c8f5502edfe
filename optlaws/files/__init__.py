"""Files in and out: inputs are read completely and checked, outputs are written completely or not at all."""
