"""A law of one's own against path following: the same trials for both, a page and a CSV file."""

import subprocess
import sys
import tempfile
from pathlib import Path

law, folder = Path(__file__).with_name("own_law.py"), Path(tempfile.mkdtemp())
arena = [sys.executable, "-m", "onpath", "arena", f"{law}:SlidingMode", "path_following", "--only"]
short = ["--robot", "five_bar", "--rounds", "1", "--no-figures"]  # the first table alone
subprocess.run([*arena, *short], cwd=folder, check=True)
print(f"open {folder / 'arena.html'}")
