"""The control laws, one in each module; `registry.py` finds them."""
