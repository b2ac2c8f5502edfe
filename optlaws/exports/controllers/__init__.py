"""Programs of controllers that run polynomials: CODESYS CamBuilder, TwinCAT, Siemens LCamHdl, B&R, and source code."""
