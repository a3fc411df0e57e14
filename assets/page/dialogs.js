// Closes dialogs by Escape, a press beside them, or an x. Each presses the dialog's own
// button [data-close], because only the lab can close viser's dialogs. The focus then returns to
// where it was.
(() => {
  "use strict";

  const DIALOG = ".mantine-Modal-content";

  // The button after the mark, in the topmost dialog.
  function closing() {
    const dialog = [...document.querySelectorAll(DIALOG)].pop();
    const mark = dialog?.querySelector("[data-close]");
    if (!mark) return undefined;
    const after = (button) => mark.compareDocumentPosition(button) & Node.DOCUMENT_POSITION_FOLLOWING;
    return [...dialog.querySelectorAll("button")].find(after);
  }

  document.addEventListener("keydown", (event) => {
    const list = document.activeElement?.getAttribute("aria-expanded") === "true";
    if (event.key !== "Escape" || list) return;
    const button = closing();
    if (button === undefined) return;
    event.stopImmediatePropagation();
    button.click();
  }, { capture: true });

  document.addEventListener("mousedown", (event) => {
    if (!(event.target instanceof Element) || event.target.closest(DIALOG)) return;
    if (event.target.closest(".mantine-Modal-root")) closing()?.click();
  }, { capture: true });

  let opener = null, isOpen = false;
  document.addEventListener("focusin", (event) => {
    if (!event.target.closest(".mantine-Modal-root")) opener = event.target;
  });

  function returnFocus() {
    const wasOpen = isOpen;
    isOpen = document.querySelector(DIALOG) !== null;
    if (wasOpen && !isOpen && document.activeElement === document.body) opener?.focus();
  }

  function addCross() {
    for (const dialog of document.querySelectorAll(DIALOG)) {
      const mark = dialog.querySelector("[data-close]"), head = dialog.querySelector("header");
      if (!mark || !head || head.querySelector(".op-cross")) continue;
      const cross = document.createElement("button");
      cross.className = "op-cross";
      cross.type = "button";
      cross.tabIndex = -1;  // for the mouse alone: the dialog has a button that closes it
      cross.setAttribute("aria-hidden", "true");
      cross.title = mark.dataset.close;
      cross.textContent = "\u00d7";
      cross.addEventListener("click", () => closing()?.click());
      head.append(cross);
    }
  }

  new MutationObserver(() => {
    addCross();
    returnFocus();
  }).observe(document, { childList: true, subtree: true });
})();
