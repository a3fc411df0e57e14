// Adds what viser's page lacks: names for screen readers, folder headings that
// are buttons, and refusals that are seen wherever the panel has been scrolled. Names come from the
// labels on the page, or from the lab's texts in [data-page].
//
// React draws viser's page and may draw any part of it anew at any time, so everything is checked
// again soon after a change; elements that have a name are left alone.
(() => {
  "use strict";

  const SOON = 150;  // [ms], within which changes of the page are handled together
  const FIELD = '[role="slider"], input:not([type="hidden"]), textarea';
  const FOLDER = ".mantine-Paper-root > .mantine-Paper-root:has(> svg)";
  const ROW = ".mantine-Flex-root:has(label)";
  const COMMANDS = "button:has(.tabler-icon-list-search)";

  const UNCORRECTED = Object.entries({
    autocapitalize: "off", autocorrect: "off", autocomplete: "off", spellcheck: "false",
  });

  function set(element, name, value) {
    if (element && value && element.getAttribute(name) !== value) element.setAttribute(name, value);
  }

  // A slider's handle, the box beside it and a field to type in are named by the label of their row.
  // A required field has a mark before it, and so has one for codes, see panel/field.html.
  function nameFields() {
    for (const field of document.querySelectorAll(FIELD)) {
      if (field.labels?.length) continue;
      set(field, "aria-label", field.closest(ROW)?.querySelector("label").textContent);
    }
    const after = (mark) => mark.closest("div")?.nextElementSibling?.querySelector("input");
    for (const mark of document.querySelectorAll("[data-required]")) {
      set(after(mark), "aria-required", "true");
    }
    for (const mark of document.querySelectorAll("[data-typed-code]")) {
      for (const [name, value] of UNCORRECTED) set(after(mark), name, value);
    }
  }

  function nameFolders() {
    for (const heading of document.querySelectorAll(FOLDER)) {
      const content = heading.nextElementSibling;
      set(heading, "role", "button");
      set(heading, "tabindex", "0");
      set(heading, "aria-expanded", String(content?.getAttribute("aria-hidden") !== "true"));
    }
  }

  // Buttons with the same label are distinguished by the text before them.
  function nameButtons() {
    const marks = document.querySelectorAll("[data-names-next]");
    const buttons = marks.length ? [...document.querySelectorAll(".mantine-Modal-body button")] : [];
    for (const mark of marks) {
      const after = (button) => mark.compareDocumentPosition(button) & Node.DOCUMENT_POSITION_FOLLOWING;
      set(buttons.find(after), "aria-label", mark.dataset.namesNext);
    }
  }

  function nameTheRest() {
    const words = document.querySelector("[data-page]")?.dataset;
    if (words === undefined) return;
    set(document.getElementById("root"), "role", "main");
    set(document.querySelector(COMMANDS), "aria-label", words.keys);
    for (const arrow of document.querySelectorAll("[data-dock-region-collapse]")) {
      set(arrow, "aria-label", words.fold);
    }
    for (const cross of document.querySelectorAll(".mantine-Notification-closeButton")) {
      set(cross, "aria-label", words.close);
    }
    const scene = document.querySelector("canvas[data-engine]");
    if (scene !== null) {
      set(scene, "role", "img");
      set(scene, "aria-label", words.scene);
    }
    for (const plot of document.querySelectorAll(".uplot")) {
      const canvas = plot.querySelector("canvas");
      if (canvas === null) continue;
      set(canvas, "role", "img");
      set(canvas, "aria-label", plot.querySelector(".u-title")?.textContent);
    }
  }

  let refusals = [];

  function showRefusals() {
    const alerts = [...document.querySelectorAll('[role="alert"]')];
    const fresh = alerts.find((alert) => !refusals.includes(alert.textContent));
    refusals = alerts.map((alert) => alert.textContent);
    fresh?.scrollIntoView({ block: "nearest" });
  }

  function look() {
    due = false;
    nameFields();
    nameFolders();
    nameButtons();
    nameTheRest();
    showRefusals();
  }

  let due = false;
  const watch = new MutationObserver(() => {
    if (due) return;
    due = true;
    setTimeout(look, SOON);
  });
  const changes = { childList: true, subtree: true, attributes: true };
  watch.observe(document, { ...changes, attributeFilter: ["aria-hidden"] });

  document.addEventListener("keydown", (event) => {
    const heading = event.target;
    if (!(heading instanceof Element) || !heading.matches(FOLDER)) return;
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    heading.click();
  }, { capture: true });
})();
