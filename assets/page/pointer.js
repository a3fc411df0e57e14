// The mouse in the scene: the left button and one finger are for the robots alone, so that a press
// beside an end-point does not tilt the view; the right button turns it, two fingers move it.
//
// viser's camera listens to movements at the document, and what is dragged at the window, which
// hears later. This script runs before viser's and hears first at the document.
(() => {
  "use strict";

  const LEFT = 1, RIGHT = 2;  // in event.buttons
  const fingers = new Set();
  let inScene = false;

  addEventListener("pointerdown", (event) => {
    inScene = event.target instanceof Element && event.target.matches("canvas[data-engine]");
    if (event.pointerType === "touch") fingers.add(event.pointerId);
  }, { capture: true });
  for (const end of ["pointerup", "pointercancel"]) {
    addEventListener(end, (event) => fingers.delete(event.pointerId), { capture: true });
  }

  function told(target, event, changes = {}) {
    target.dispatchEvent(new PointerEvent(event.type, { ...copied(event), ...changes }));
  }

  // Constructors read what is inherited, too, but Object.assign does not.
  function copied(event) {
    const names = ["pointerId", "pointerType", "isPrimary", "clientX", "clientY", "screenX", "screenY",
      "buttons", "button", "ctrlKey", "shiftKey", "altKey", "metaKey", "pressure", "movementX", "movementY"];
    return Object.fromEntries(names.map((name) => [name, event[name]]));
  }

  document.addEventListener("pointermove", (event) => {
    if (!inScene || !event.isTrusted) return;
    const touched = event.pointerType === "touch";
    if (touched ? fingers.size === 1 : event.buttons === LEFT) {
      event.stopImmediatePropagation();
      told(window, event);
    } else if (!touched && event.buttons === RIGHT && !event.shiftKey) {
      event.stopImmediatePropagation();
      told(document, event, { buttons: LEFT });
    }
  });
})();
