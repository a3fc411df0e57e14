// Gives keys to the focused control and to the lab; none of them moves the camera.
//
// viser's page listens to keys at the end of their propagation: its hotkeys, which are the lab's keys,
// at the <html> element, and its camera at the document. This script runs before viser's, so at each
// of these it gets a key first, after the focused control, and can stop its propagation.
(() => {
  "use strict";

  const ARROWS = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"];
  const CAMERA = ["KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE", ...ARROWS];  // by event.code
  const PRESS = [" ", "Enter"];
  const MOVE = [...ARROWS, "Home", "End"];

  // Which keys a control uses itself, by event.key; fields to type in are left to viser.
  const OWN = [
    ['[role="slider"]', MOVE],
    ['[role="tab"]', [...MOVE, ...PRESS]],
    ['input[type="radio"]', [...ARROWS, ...PRESS]],
    ['button, summary, [role="button"], input[type="checkbox"]', PRESS],
  ];
  const TYPED = "input, textarea, select, [contenteditable]";
  const TICKED = 'input[type="checkbox"], input[type="radio"]';

  // In viser's boxes of several lines, Enter presses the button below it, and Shift+Enter begins a new line. viser
  // sends only the newest message of every 50 ms, so the text must be sent before the press.
  const LINES = "textarea:not(#op-column *)";
  const TYPED_GOES = 60;  // [ms]

  function pressBelow(box) {
    const controls = [...document.querySelectorAll("textarea, button")];
    const below = controls.slice(controls.indexOf(box) + 1).find((each) => each.matches("button"));
    if (below !== undefined) setTimeout(() => below.click(), TYPED_GOES);
  }

  // A letter of another alphabet counts as the Latin one on its key, since shortcuts are Latin letters.
  function latin(event) {
    const other = /^\p{L}+$/u.test(event.key) && !/[a-z]/i.test(event.key);
    const found = other && !event.altKey ? /^Key([A-Z])$/.exec(event.code) : null;
    return found ? found[1].toLowerCase() : event.key;
  }

  function isOwn(control, key) {
    const found = OWN.find(([selector]) => control.matches(selector));
    return found !== undefined && found[1].includes(key);
  }

  // viser's hotkeys treat every <input> as a text field. A checkbox has no use for letters, so they are
  // dispatched again as if nothing had the focus.
  function tellAgain(event, key = event.key) {
    event.stopImmediatePropagation();
    const { type, code, repeat, ctrlKey, metaKey, altKey, shiftKey } = event;
    const init = { key, code, repeat, ctrlKey, metaKey, altKey, shiftKey, bubbles: true, cancelable: true };
    const again = new KeyboardEvent(type, init);
    if (!document.body.dispatchEvent(again)) event.preventDefault();
  }

  document.documentElement.addEventListener("keydown", (event) => {
    const control = event.target;
    if (!(control instanceof Element)) return;
    const begins = event.shiftKey || event.isComposing;
    if (control.matches(LINES) && event.key === "Enter" && !begins) {
      event.preventDefault();
      if (!event.repeat) pressBelow(control);
    } else if (isOwn(control, event.key)) event.stopImmediatePropagation();
    else if (control.matches(TICKED) && event.key !== "Tab") tellAgain(event, latin(event));
    else if (latin(event) !== event.key && !control.matches(TYPED)) tellAgain(event, latin(event));
  });

  document.addEventListener("keydown", (event) => {
    if (CAMERA.includes(event.code)) event.stopImmediatePropagation();
  });
})();
