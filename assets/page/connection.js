// Tells users who wait in vain that the lab does not answer. viser's worker reports when it has connected, and when the connection has ended.
(() => {
  "use strict";

  const PATIENCE = 10000;  // [ms]

  const box = document.createElement("p");
  box.className = "op-notice";
  box.setAttribute("role", "alert");
  let waiting = setTimeout(tell, PATIENCE);

  function tell() {
    box.lang = ownWords.language;
    document.body.append(box);
    box.textContent = ownWords.text.silent;
  }

  function hear({ data }) {
    if (data?.type !== "connected" && data?.type !== "closed") return;
    if (data.type === "closed") {  // repeated at every attempt
      waiting ||= setTimeout(tell, PATIENCE);
      return;
    }
    clearTimeout(waiting);
    waiting = 0;
    box.remove();
  }

  window.Worker = class extends Worker {
    constructor(...how) {
      super(...how);
      this.addEventListener("message", hear);
    }
  };
})();
