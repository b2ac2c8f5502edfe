"""What `optlaws run` does: a problem file names its job."""
