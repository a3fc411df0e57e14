"""What a SCORM package tells its platform, in both versions, and a student who does all."""

from __future__ import annotations

from pathlib import Path

RUNTIME = Path(__file__).parents[1] / "vendor" / "scorm-again"
MADE = {
    "1.2": ("scorm12.min.js", "API", "Scorm12API"),
    "2004": ("scorm2004.min.js", "API_1484_11", "Scorm2004API"),
}
STATUS = {"1.2": "cmi.core.lesson_status", "2004": "cmi.completion_status"}
SCORE = {"1.2": "cmi.core.score.raw", "2004": "cmi.score.scaled"}
FULL = {"1.2": 100, "2004": 1}
MOST = {"1.2": 4096, "2004": 64000}
DO_ALL = """() => {
    site.page.steps.forEach((step, i) => {
        site.notes.seen = i + 1
        if (step.script) site.notes.played[i] = true
        step.blocks.forEach((block, j) => {
            const give = (item, said) => site.notes.given.push({item, attempt: 1, ...said})
            if (block.kind === "task") give(block.id, {number: 1, right: true, way: 0})
            if (block.kind === "quiz") give(`${i}.${j}`, {answer: {option: block.right}})
            if (block.kind === "choice") give(String(i), {answer: {option: 0}})
            if (block.kind === "sketch") give(String(i), {answer: {times: [0, 1], values: [0, 1]}})
        })
    })
    site.student.save()
}"""
"""As if all had been done, and all of it right."""
JUDGED = """site.page.steps.flatMap((step, i) => step.optional ? [] : step.blocks.flatMap(
    (block, j) => ["quiz", "task"].includes(block.kind) ? [[i, j, block.right ?? null]] : []))"""
"""Step and place of what is judged, and the right option of a quiz."""
