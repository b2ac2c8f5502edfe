"""The job "cam": cams of cycles, analysed with enclosed extremes."""
