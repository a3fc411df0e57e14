"""The panels and plots of one browser tab."""
