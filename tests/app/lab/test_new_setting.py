"""Whoever adds a setting writes its declaration and its words, and it is everywhere.

The settings are added to the source before anything is imported, in a process of its own.
"""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import onpath.models.closed_loop.lab_settings as lab_settings
import onpath.models.systems.parameters as parameters

SETTING = """
    trails: float = own(
        number(
            1.5, "s", (0.5, 5.0, 0.5), "how long the trails are", group="view", label="Trails"
        )
    )
"""
PARAMETER = """
    wind: float = number(
        0.0, "N", (0, 9, 0.5), "a wind that blows to the right", group="realism", label="Wind"
    )
"""
GERMAN = """
parameter-trails-label = Spuren
parameter-trails-help = wie lang die Spuren sind
parameter-wind-label = Wind
parameter-wind-help = ein Wind nach rechts
"""

ADD = """
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import spec_from_file_location
from pathlib import Path

BEFORE, GERMAN = {before!r}, {german!r}

class Adding(SourceFileLoader):
    def get_code(self, fullname):
        before, declaration = BEFORE[fullname]
        text = self.get_data(self.path).decode()
        assert text.count(before) == 1
        text = text.replace(before, declaration.lstrip("\\n") + before)
        return compile(text, self.path, "exec")

class Finder:
    def find_spec(self, name, path=None, target=None):
        if name not in BEFORE:
            return None
        files = (Path(folder) / (name.rpartition(".")[2] + ".py") for folder in path)
        file = str(next(file for file in files if file.exists()))
        return spec_from_file_location(name, file, loader=Adding(name, file))

sys.meta_path.insert(0, Finder())
from onpath.assets import messages
from fluent.syntax import FluentParser
parsed = messages._resource

def with_new_words(language):
    resource = parsed(language)
    if language == "de" and not any("wind" in str(getattr(e, "id", "")) for e in resource.body):
        resource.body += FluentParser(with_spans=False).parse(GERMAN).body
    return resource

messages._resource = with_new_words
"""


@pytest.mark.thorough
def test_a_setting_is_declared_once_and_is_everywhere() -> None:
    before = {
        lab_settings.__name__: ("    presenting: bool = own(", SETTING),
        parameters.__name__: ("    sensor_noise: float = number(", PARAMETER),
    }
    script = ADD.format(before=before, german=GERMAN) + textwrap.dedent(EVERYWHERE)
    done = subprocess.run(
        [sys.executable, "-c", script],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        cwd=Path(__file__).parents[3],
    )
    assert done.returncode == 0, done.stderr


EVERYWHERE = """
import contextlib, io
import pytest
import onpath
from onpath.app.cli.main import run_command
from onpath.app.lab import commands as c
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.share_code import encode
from onpath.app.lab.setups.step_setup import setup_from
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.new_lab import new_lab as newcomers_lab
from onpath.app.view.forms import setting_field
from onpath.app.view.lab_form import form_of, refusals_in, values_in
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import NO_LESSONS
from onpath.lessons.vocabulary.lists import names_markdown
from onpath.lessons.vocabulary.setups import setup_faults
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import lab_specs
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache, new_lab, run

NEW = {"trails": 3.0, "wind": 2.0}


def shown(lab):
    values = take_page_snapshot(lab, 1.0).values
    return {name: values[name] for name in NEW}


# In the lab: shown with its default, set by the one command, refused out of range.
lab = new_lab()
assert shown(lab) == {"trails": 1.5, "wind": 0.0}
do(lab, *[c.Set(name, value) for name, value in NEW.items()])
assert shown(lab) == NEW and not lab.refused
do(lab, *[c.Set(name, 99.0) for name in NEW])
snapshot = take_page_snapshot(lab, 1.0)
assert shown(lab) == NEW and snapshot.refused.keys() == NEW.keys()

# In the form, in both languages.
for name, spec in lab_specs(FIVE_BAR.parameters).items():
    if name in NEW:
        english, german = (
            setting_field(name, spec, Words(each), default=0.0) for each in ("en", "de")
        )
        assert english.label == spec.label and english.help == spec.help
        assert (english.low, english.high, english.unit) == (spec.low, spec.high, spec.unit)
        assert german.label == {"trails": "Spuren", "wind": "Wind"}[name]
        assert german.help.startswith(("wie lang", "ein Wind"))

# In the form of the lab, and of a lesson's step that names it.
setup = StepSetup(controls=tuple(NEW), set=NEW)
for step, marks in ((None, {}), (setup, NEW)):
    form = form_of(snapshot, step, Words("de"))
    fields = {each.name: each for group in form.groups for each in group.fields if each.name in NEW}
    assert fields.keys() == NEW.keys()
    assert {name: each.mark for name, each in fields.items() if each.mark is not None} == marks
shows = values_in(snapshot, {}, (), Words("de"))
assert {name: shows[name] for name in NEW} == NEW and refusals_in(snapshot).keys() == NEW.keys()

# In a share code.
other = new_lab()
do(other, c.UseShared(encode(capture(lab.simulation))))
assert shown(other) == NEW

# In a lesson: as a control, in its set-up, which the next step takes back.
setup = StepSetup(set=NEW, controls=tuple(NEW))
assert list(setup_faults(setup, "five_bar")) == []
assert list(setup_faults(StepSetup(set={"trails": 99.0}), "five_bar"))
lab = new_lab()
lab.set_up(setup_from(setup, "five_bar"))
assert shown(lab) == NEW
lab.set_up(setup_from(StepSetup(), "five_bar"))
assert shown(lab) == {"trails": 1.5, "wind": 0.0}

# In `simulate`, as far as it belongs to a robot.
with pytest.warns(UserWarning, match="no effect.*wind"):
    onpath.simulate(wind=2.0, duration=0.01)
with pytest.raises(ValueError, match="wind"):
    onpath.simulate(wind=99.0, duration=0.01)
assert "a wind" in onpath.parameters("five_bar")["wind"]

# On the command line: for an experiment, and for new labs.
said = io.StringIO()
with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
    assert run_command(["experiment", "position", "--set", "wind=2,duration=0.01"]) == 0
    assert run_command(["experiment", "position", "--set", "wind=99"]) == 2
    assert run_command(["serve", "--set", "trails=99"]) == 2
assert "trails: 99 is not between 0.5 and 5 s" in said.getvalue()
lab = newcomers_lab(loop_cache(), NO_LESSONS, settings={"trails": "3", "wind": "2"})
run(lab, 0.1)
assert shown(lab) == NEW

# In the help.
listed = io.StringIO()
with contextlib.redirect_stdout(listed):
    run_command(["names"])
for name in NEW:
    assert f"{name} " in listed.getvalue() and f"`{name}`" in names_markdown()
"""
