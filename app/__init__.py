"""The lab: the only place with viser, threads and a clock."""
