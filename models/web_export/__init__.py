"""What pages without a server compute besides closed loops, as functions to translate."""
