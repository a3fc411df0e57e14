"""The commands of `onpath`."""
