"""Studies: many problems solved on all cores or on a cluster, safe against interruption."""
