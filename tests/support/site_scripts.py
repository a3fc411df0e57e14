"""What a site's page computes for a step, without a browser: its scripts, run by Node.

The page itself is another matter: see `tests/in_browser`.
"""

from __future__ import annotations

import json
import shutil
import subprocess
from functools import cache
from tempfile import NamedTemporaryFile
from typing import Any

import pytest

from onpath.app.exports.site.step_actions import script_acts
from onpath.app.exports.site.step_data import site_step
from onpath.app.exports.site.step_figures import step_figure
from onpath.app.exports.site.task_data import check_words, task_data
from onpath.assets import asset_path
from onpath.lessons.action_schema import Script
from onpath.lessons.schema import Lesson
from onpath.lessons.task_schema import Reference, Task
from onpath.lessons.words import ENGLISH

ESBUILD = asset_path("web/node_modules/.bin/esbuild")
needs_node = pytest.mark.skipif(
    not (shutil.which("node") and ESBUILD.exists()), reason="run npm ci in assets/web"
)
PLAYER = """
import { judge } from "./lessons/checks"
import { EarlierRun } from "./lessons/earlier"
import { Recorded } from "./lessons/recorded"
import { Kernels } from "./simulation/kernels"
import { readFileSync } from "node:fs"

const { figure, remade, values, words, plays } = JSON.parse(readFileSync(0, "utf8"))
const ticksAt = frame => Math.floor(frame / 60 / figure.dt + 1e-9)
const names = Object.keys(remade)

/** Do what a reader does who changes the robot, which gives another simulation. */
async function done({ script, checks }) {
    let simulation = new Recorded(figure, await Kernels.from(figure.module), values, names)
    const earlier = new EarlierRun(), waiting = [...script.do]
    let [passed, verdicts, before] = [false, [], 0]
    for (let frame = 0, now = 0; before + now < script.until - 1e-9; now = ++frame / 60) {
        while (waiting.length && waiting[0][0] <= before + now + 1e-9) {
            const [, action] = waiting.shift(), { run, time } = simulation
            const name = names.find(each => each in (action.set ?? {}))
            if (name) {
                const value = action.set[name], other = remade[name][String(value)]
                const next = new Recorded(other, await Kernels.from(other.module), values, names)
                next.goOnFrom(simulation, name, value)
                simulation = next
            } else simulation.act(action)
            if (simulation.run !== run) [before, frame, now] = [before + time, 0, 0]
        }
        simulation.advance(ticksAt(frame + 1) - ticksAt(frame))
        if (frame % 6) continue
        const record = simulation.record(earlier.values)
        earlier.follow(record, checks, words)
        verdicts = judge(checks, record, words)
        passed ||= verdicts.every(each => each.passed)
    }
    return { passed, verdicts }
}

/** Play a script, and look at the checks ten times a second. */
async function played({ script, checks, quantity }) {
    const simulation = new Recorded(figure, await Kernels.from(figure.module), values)
    const earlier = new EarlierRun()
    let [going, passed, verdicts] = [true, false, []]
    simulation.play(script, () => {}, () => (going = false))
    while (going) {
        simulation.advance(Math.round(0.1 / figure.dt))
        const record = simulation.record(earlier.values)
        earlier.follow(record, checks, words)
        verdicts = judge(checks, record, words)
        passed ||= verdicts.every(each => each.passed)
    }
    const { recent, sides } = simulation
    const { values: settings } = simulation
    return { passed, verdicts, settings, curve: quantity ? simulation.curve(quantity) : null,
        rows: sides.map(side => [...side.logged()]) }
}

const results = []
for (const play of plays) results.push(await (names.length ? done(play) : played(play)))
console.log(JSON.stringify(results))
"""


@cache
def _bundle(code: str) -> str:
    """Code and the pages' scripts that it imports as one script."""
    home = asset_path("web")
    page = "globalThis.matchMedia = () => ({ addEventListener() {} })"
    options = ["--bundle", "--format=esm", "--platform=node", "--loader=ts", f"--banner:js={page}"]
    command = [str(ESBUILD), *options]
    made = subprocess.run(command, input=code, cwd=home, text=True, stdout=-1, check=True)
    return made.stdout


def answer_of(code: str, data: Any) -> Any:
    """What code prints that reads data as JSON and imports the pages' scripts."""
    with NamedTemporaryFile("w", encoding="utf-8", suffix=".mjs") as file:
        file.write(_bundle(code))
        file.flush()
        command, given = ["node", file.name], json.dumps(data)
        run = subprocess.run(command, input=given, text=True, stdout=-1, check=True)
    return json.loads(run.stdout)


def play_on_site(lesson: Lesson, index: int, plays: list[tuple[Script, Task | None]]) -> Any:
    """What a step's page makes of scripts: verdicts on a task, if any, and the last log rows."""
    figure, step = step_figure(lesson, index), lesson.steps[index]
    references = {task.id: Reference(Script(), Script()) for task in step.tasks()}
    site = site_step(lesson, index, references, ENGLISH)
    laws = lesson.setup_at(index).laws.named
    data = {
        "figure": site.figure,
        "remade": site.remade,
        "values": site.data["values"],
        "words": site.figure["words"] | check_words(ENGLISH),
        "plays": [
            {
                "script": script_acts(script, figure.choice),
                "checks": task_data(task, figure.choice.parameters, laws, ENGLISH)["checks"]
                if task
                else [],
            }
            for script, task in plays
        ],
    }
    return answer_of(PLAYER, data)
