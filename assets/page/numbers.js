// viser's number boxes keep what is typed, and say what is wrong with it. They drop characters
// that they do not know, so that 1e9 becomes 19; they use every digit at once, so that 4 takes effect on
// the way to 400; and they stay empty once they are emptied.
//
// Typing in a box opens a text field over it, which accepts anything. The text is read on Enter or when
// the field loses the focus: a number goes into the box, anything else stays, and a note says why. Not
// every on-screen keyboard lets its input be redirected; then the box is checked when it loses the focus.
(() => {
  "use strict";

  const BOX = "input[inputmode]:not(#op-column *)";
  const SOON = 100;  // [ms], by which a box has changed what it does not accept

  const field = document.createElement("input"), note = document.createElement("div");
  field.id = "op-typed";
  field.autocomplete = "off";
  note.id = "op-wrong";
  note.setAttribute("aria-live", "assertive");
  field.hidden = note.hidden = true;

  let box = null, before = "", typed, marked = null, filling = false;

  function words(name, values = {}) {
    const said = document.querySelector("[data-page]")?.dataset[name] ?? "";
    return said.replace(/\[(\w+)\]/g, (_, key) => values[key] ?? "");
  }

  function read(text) {
    const plain = text.replace(/\s/g, "").replace("\u2212", "-").replace(",", ".");
    return plain === "" ? NaN : Number(plain);
  }

  // Whether a text looks like an integer with separated thousands, as the page's language writes them.
  function grouped(text) {
    const german = document.querySelector("[data-page]")?.dataset.language === "de";
    return (german ? /^[-\u2212]?[1-9]\d{0,2}\.\d{3}$/ : /^[-\u2212]?[1-9]\d{0,2},\d{3}$/).test(text.trim());
  }

  function place() {
    const over = (field.hidden ? marked : box)?.getBoundingClientRect();
    if (!over) return;
    if (!field.hidden) {
      Object.assign(field.style, { left: `${over.right - Math.max(over.width, 96)}px`, top: `${over.top}px` });
      Object.assign(field.style, { width: `${Math.max(over.width, 96)}px`, height: `${over.height}px` });
    }
    note.style.top = `${over.bottom + 4}px`;
    note.style.right = `${Math.max(innerWidth - over.right, 8)}px`;
  }

  function say(said, at) {
    if (!document.body.contains(note)) document.body.append(field, note);
    unsay();
    note.textContent = said;
    note.hidden = false;
    marked = at;
    at.setAttribute("aria-invalid", "true");
    at.setAttribute("aria-describedby", note.id);
    place();
  }

  function unsay() {
    note.hidden = true;
    marked?.removeAttribute("aria-invalid");
    marked?.removeAttribute("aria-describedby");
    marked = null;
  }

  // Put a text into a box as if it had been typed.
  function fill(into, text) {
    filling = true;
    Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, "value").set.call(into, text);
    into.dispatchEvent(new InputEvent("input", { bubbles: true }));
    filling = false;
  }

  // The value that a box has made of a text once it has lost the focus.
  function check(left, text, last) {
    setTimeout(() => {
      if (!left.isConnected) return;
      if (text.trim() === "") {
        if (left.value === "") fill(left, last);
        say(words("empty", { value: left.value }), left);
      } else if (read(text) !== read(left.value)) {
        say(words("changed", { typed: text, value: left.value }), left);
      } else if (grouped(text)) {
        say(words("grouped", { typed: text, value: left.value }), left);
      }
    }, SOON);
  }

  function open(over, text, caret) {
    box = over;
    unsay();
    if (!document.body.contains(field)) document.body.append(field, note);
    field.setAttribute("aria-label", over.getAttribute("aria-label") ?? over.labels?.[0]?.textContent ?? "");
    field.value = text;
    field.hidden = false;
    place();
    field.focus();
    field.setSelectionRange(caret, caret);
  }

  function close(stays) {
    const from = box, text = field.value, number = read(text), last = before;
    if (from === null) return;
    if (text.trim() !== "" && !Number.isFinite(number)) {
      say(words("nonumber", { typed: text, value: before }), field);
      return;
    }
    unsay();
    box = null;
    if (stays) from.focus();
    field.hidden = true;
    if (text.trim() !== "") {
      fill(from, number.toLocaleString("en-US", { useGrouping: false, maximumFractionDigits: 20 }));
    }
    from.dispatchEvent(new FocusEvent("focusout", { bubbles: true }));  // it clamps to its limits
    check(from, text, last);
  }

  function putBack() {
    const from = box;
    unsay();
    box = null;
    from?.focus();
    field.hidden = true;
  }

  // The text of a box after a change, and its caret.
  function changed(over, { data, inputType }) {
    let [begin, end] = [over.selectionStart ?? 0, over.selectionEnd ?? 0];
    if (inputType.startsWith("delete") && begin === end) {
      const whole = /Word|Line/.test(inputType);
      if (inputType.includes("Backward")) begin = whole ? 0 : Math.max(begin - 1, 0);
      else end = whole ? over.value.length : end + 1;
    }
    const typed = data ?? "";
    return [over.value.slice(0, begin) + typed + over.value.slice(end), begin + typed.length];
  }

  document.addEventListener("beforeinput", (event) => {
    const over = event.target;
    if (!(over instanceof HTMLInputElement) || !over.matches(BOX) || !event.cancelable) return;
    if (!/^(insert(?!LineBreak)|delete)/.test(event.inputType)) return;
    event.preventDefault();
    open(over, ...changed(over, event));
  }, { capture: true });

  document.addEventListener("focusin", (event) => {
    const entered = event.target;
    if (entered === field || !(entered instanceof HTMLInputElement) || !entered.matches(BOX)) return;
    if (entered.value !== "") before = entered.value;
    typed = undefined;
  }, { capture: true });

  document.addEventListener("input", (event) => {
    if (filling || !(event.target instanceof HTMLInputElement) || !event.target.matches(BOX)) return;
    typed = event.target.value;
    unsay();
  }, { capture: true });

  document.addEventListener("focusout", (event) => {
    if (event.target === field) close(false);
    else if (event.isTrusted && event.target.matches?.(BOX) && typed !== undefined && field.hidden) {
      check(event.target, typed, before);
      typed = undefined;
    }
  }, { capture: true });

  document.addEventListener("keydown", (event) => {
    const at = event.target;
    if (at === field && (event.key === "Enter" || event.key === "Tab")) close(true);
    else if (at === field && event.key === "Escape") putBack();
    else if (event.key === "Enter" && at instanceof HTMLInputElement && at.matches(BOX) && typed !== undefined) {
      at.dispatchEvent(new FocusEvent("focusout", { bubbles: true }));
      check(at, typed, before);
      typed = undefined;
    } else if (at !== field) unsay();
  }, { capture: true });

  document.addEventListener("pointerdown", (event) => {
    if (event.target !== field && field.hidden) unsay();
  }, { capture: true });
  document.addEventListener("scroll", place, { capture: true, passive: true });
  addEventListener("resize", place);

  // A note is removed with its box.
  new MutationObserver(() => {
    if (marked !== null && marked !== field && !marked.isConnected) unsay();
    if (box !== null && !box.isConnected) putBack();
  }).observe(document, { childList: true, subtree: true });
})();
