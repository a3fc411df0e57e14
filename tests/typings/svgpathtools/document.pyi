from collections.abc import Callable
from xml.etree.ElementTree import Element

CONVERSIONS: dict[str, Callable[[Element], str]]
