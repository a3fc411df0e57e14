"""OnPath: a browser lab in which path following and trajectory tracking can be compared."""
