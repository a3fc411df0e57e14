"""Virtual outputs, control laws, and the analysis of both (poles, rank test)."""
