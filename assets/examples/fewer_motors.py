"""Two motors for three coordinates: where the pen may be on a rod that no motor drives."""

import onpath

for alpha in (0.9, 1.1):  # the pen's place, as a share of the way to the centre of percussion
    print(alpha, onpath.simulate("rod_gantry", "circle", alpha=alpha))  # from 1 on, it warns
