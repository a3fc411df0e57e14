"""A pendulum stands on a cart without a motor: one law lets it fall, and one swings with it."""

import onpath

for law in ("path_following", "orbital_stabilization"):
    top = {"start": (0, 0.05), "pendulum": "upright"}
    run = onpath.simulate("cart_pendulum", "circle", law, duration=6, **top)
    angle = run.trajectory.fields["q"][-1000:, 2]
    print(f"{law}: the pendulum leans by up to {abs(angle).max():.2f} rad in the last second")
