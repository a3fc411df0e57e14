"""viser's types of key names, which its public functions take but which it does not export."""

from viser._messages import HotkeyKey, KeyModifier

__all__ = ["HotkeyKey", "KeyModifier"]
