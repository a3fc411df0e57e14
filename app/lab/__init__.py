"""One user's lab, without viser, threads or databases."""
