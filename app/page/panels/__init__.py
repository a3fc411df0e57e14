"""The widgets of one client, one panel per module. They post commands and show snapshots."""
