"""What pages show, as data: pure functions of snapshots, course and words."""
