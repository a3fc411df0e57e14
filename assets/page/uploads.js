// Sends only the beginning of a file that is too large. The lab refuses it with a message; if all of it were
// sent, the lab would close the connection.
(() => {
  "use strict";

  const MOST = 1_500_000; // bytes; more than any file that is read

  document.addEventListener("change", (event) => {
    const input = event.target;
    if (!(input instanceof HTMLInputElement) || input.type !== "file") return;
    const file = input.files?.[0];
    if (file === undefined || file.size <= MOST) return;
    const beginning = new DataTransfer();
    beginning.items.add(new File([file.slice(0, MOST)], file.name, { type: file.type }));
    input.files = beginning.files;
  }, { capture: true });
})();
