"""The controller without the plant: what goes to a real robot."""
