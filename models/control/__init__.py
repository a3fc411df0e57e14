"""Virtual outputs, control laws, and what can be said of them."""
