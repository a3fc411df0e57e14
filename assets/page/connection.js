// Tells users who wait in vain that the lab does not answer, and at once when a connection is lost, in the
// language of the page, or the browser's while the page has no texts yet. viser's worker reports when it
// has connected, and when the connection has ended.
(() => {
  "use strict";

  const PATIENCE = 10000;  // [ms] until the first connection
  const MOVES = 1500;  // [ms], within which the page of a lab that moves to another process reconnects

  const box = document.createElement("p");
  box.className = "op-notice";
  box.setAttribute("role", "alert");
  let waiting = setTimeout(tell, PATIENCE, "silent");

  function tell(what) {
    box.lang = ownWords.language();
    document.body.append(box);
    box.textContent = ownWords.text()[what];
  }

  function hear({ data }) {
    if (data?.type !== "connected" && data?.type !== "closed") return;
    if (data.type === "closed") {  // repeated at every attempt
      waiting ||= setTimeout(tell, MOVES, "lost");
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
