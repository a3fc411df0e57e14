"""The paper's experiments, and the identification of a robot's parameters."""
