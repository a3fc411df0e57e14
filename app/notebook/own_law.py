"""What a custom law is made of: see `python_law` and models/README.md."""

from onpath.models.control.laws.law import View as View
from onpath.models.control.laws.law import own_gain as own_gain
from onpath.models.control.laws.path_following import followed as followed
from onpath.models.control.laws.path_following import tangential as tangential
from onpath.models.control.laws.python_law import Now as Now
