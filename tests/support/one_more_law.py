"""A plugin of pytest: the registry finds the law of tests/data/one_more_law."""

from __future__ import annotations

from onpath.models.control import laws
from tests.support.checkout import ROOT

laws.__path__.append(str(ROOT / "tests" / "data" / "one_more_law"))
