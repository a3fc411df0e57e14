from svgpathtools.path import Arc as Arc
from svgpathtools.path import Line as Line
from svgpathtools.path import Path

def parse_path(pathdef: str) -> Path: ...
