"""The mathematics of path following: paths, robots, control laws, closed loops, experiments."""
