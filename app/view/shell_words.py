"""The messages of what stands around the stage of the lab's page; see assets/web/pages/shell.ts."""

from __future__ import annotations

AIDS = ("hold", "pull", "bend", "aim", "lens", "chart", "view", "search")
"""What the help names; see assets/web/parts/help_sheet.ts."""
SHEETS = (
    "robots",
    "laws",
    "compare",
    "keep",
    "lessons",
    "help",
    "display",
    "file",
    "class",
    "teach",
)
KINDS = ("open", "robot", "law", "path", "lesson", "key")
SHELL = (
    *("lesson.controls", "controls.help", "panel.handle", "head.more"),
    *("search.title", "search.hint", "search.found", "search.none"),
    *(f"search.kind_{kind}" for kind in KINDS),
    *(f"search.of_{sheet}" for sheet in SHEETS),
    *("display.title", "display.speaks", "display.sounds", "lesson.language", "lesson.presenting"),
    *("look.title", "look.system", "look.light", "look.dark"),
    *("help.title", "help.point", "help.keys", "help.own_keys"),
    *("keys.time", "keys.hand", "keys.path", "keys.wall", "keys.rest"),
    *("glossary.to_terms", "glossary.to_words"),
    *(f"aid.{name}" for name in AIDS),
    *(f"aid.{name}_means" for name in AIDS),
    *("laws.about", "laws.own_heading", "laws.name", "laws.meaning", "laws.unit"),
    *("lesson.choose", "lesson.done", "lesson.begun", "route.routes", "route.follow"),
    *("lesson.begin_here", "lesson.go_on_here"),
    "robots.choose",
    "robots.illustrative",
    *("keep.title", "keep.yours", "keep.other", "keep.other_hint", "keep.go", "keep.share"),
    *("keep.shared", "keep.paste", "keep.paste_hint", "keep.use", "keep.report"),
    *("keep.with_code", "keep.with_code_means", "keep.sharing", "keep.coming_back", "keep.record"),
    *("code.copy", "code.copied"),
    *("class.title", "class.join", "class.leave", "class.code", "class.code_hint"),
    *("class.nickname", "class.nickname_hint", "class.what_stored", "class.privacy"),
    *("class.then", "class.gone", "class.elsewhere", "class.ask_place"),
    *("class.forget_me", "class.forget_me_sure"),
    *("class.teacher", "class.key", "class.key_hint", "class.teach"),
    *("design.files", "design.size", "design.size_hint", "design.radius", "design.radius_hint"),
    *("design.open", "design.open_hint", "design.upload", "design.reading", "design.lines"),
    *("design.turn", "design.turn_hint", "design.parts", "design.parts_hint"),
    *("design.right", "design.right_hint", "design.up", "design.up_hint"),
    *("export.title", "export.table", "export.picture", "export.lines", "export.film"),
    *("compare.title", "compare.text", "compare.laws", "compare.obstruction", "compare.run"),
    *("compare.law", "compare.distance", "compare.delay", "compare.force", "compare.put"),
    *("compare.put_left", "compare.put_right", "compare.on_left", "compare.on_right"),
    *("compare.on_both", "compare.stopped", "compare.stopped_text", "compare.picture"),
    *("compare.time", "compare.curves"),
    *("question.yes", "question.no"),
)
FILLED = {
    "compare.computing": ("done", "all"),
    "compare.count": ("most",),
    "class.of": ("code",),
    "design.followed": ("file",),
    "design.chosen": ("file",),
    "class.member": ("name",),
    "class.is_it_you": ("name",),
    "class.place_asked": ("name",),
    "class.too_long": ("most",),
}
"""Messages whose values the page fills in."""
