// Boxes over the scene, in the middle of its visible part and above whatever covers its lower part: the
// panel on a telephone, or the window with a step's plot. A box later in the document is above an earlier one.
const boxesOverScene = (() => {
  "use strict";

  const BOX = ".op-over-scene";

  // A hidden box, not yet in the document.
  function make(tag, id, ...parts) {
    const box = document.createElement(tag);
    box.id = id;
    box.className = BOX.slice(1);
    box.hidden = true;
    box.append(...parts);
    return box;
  }

  // Press a key of the lab.
  function press(key) {
    const code = { " ": "Space", Escape: key }[key] ?? `Key${key.toUpperCase()}`;
    document.body.dispatchEvent(new KeyboardEvent("keydown", { key, code, bubbles: true }));
  }

  // A button that presses a key of the lab, its [data-key].
  function button(className, key = "") {
    const made = document.createElement("button");
    made.type = "button";
    made.className = className;
    made.dataset.key = key;
    made.addEventListener("click", () => {
      made.blur();  // it may be about to disappear, and the focus with it
      press(made.dataset.key);
    });
    return made;
  }

  function place() {
    if (!document.querySelector(`${BOX}:not([hidden])`)) return;
    const scene = document.querySelector("canvas[data-engine]")?.getBoundingClientRect();
    if (!scene) return;
    const sheet = document.querySelector('.mantine-Paper-root[style*="bottom: 0"]');
    const plot = document.querySelector("[data-step-plot]")?.closest(".mantine-Paper-root");
    const tops = [sheet, plot].map((each) => each?.getBoundingClientRect().top ?? scene.bottom);
    const bottom = Math.min(scene.bottom, ...tops);
    let above = innerHeight - bottom + 12;
    for (const each of document.querySelectorAll(BOX)) {
      const onTop = each.dataset.place === "top";  // what it is about is below it
      each.style.top = onTop ? `${scene.top + 8}px` : "auto";
      each.style.left = `${scene.left + scene.width / 2}px`;
      each.style.bottom = onTop ? "auto" : `${above}px`;
      each.style.maxWidth = `${Math.min(scene.width - 24, 560)}px`;
      if (!onTop) above += each.offsetHeight && each.offsetHeight + 8;
    }
  }

  addEventListener("resize", place);
  return { button, make, place, press };
})();
