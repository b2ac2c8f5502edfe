"""Jobs of `optlaws run`; a problem file names its job."""
