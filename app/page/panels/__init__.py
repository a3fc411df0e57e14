"""The widgets of one client, a panel a module. They only post commands and show what is."""
