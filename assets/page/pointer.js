// The mouse in the scene: the left button and one finger are for the robots alone, so that a press
// beside an end-point does not tilt the view; the right button turns the view, and two fingers move it.
//
// viser's camera listens to movements at the document, and its drags at the window, which gets events
// later. This script runs before viser's, so at the document it gets them first.
(() => {
  "use strict";

  const LEFT = 1, RIGHT = 2;  // in event.buttons
  const fingers = new Set();
  let inScene = false;

  addEventListener("pointerdown", (event) => {
    inScene = event.target instanceof Element && event.target.matches("canvas[data-engine]");
    if (event.pointerType === "touch") fingers.add(event.pointerId);
    // viser asks for it in a passive listener, in which it has no effect and browsers warn.
    if (inScene) event.preventDefault = () => {};
  }, { capture: true });
  for (const end of ["pointerup", "pointercancel"]) {
    addEventListener(end, (event) => fingers.delete(event.pointerId), { capture: true });
  }

  function told(target, event, changes = {}) {
    target.dispatchEvent(new PointerEvent(event.type, { ...copied(event), ...changes }));
  }

  // Constructors also read inherited properties, but Object.assign does not.
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
