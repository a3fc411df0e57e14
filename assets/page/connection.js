// Tells users who wait in vain that the lab does not answer, in the browser's language, since the page
// has no texts yet. viser's worker reports when it has connected, and when the connection has ended.
(() => {
  "use strict";

  const PATIENCE = 10000;  // [ms]

  const words = JSON.parse(document.getElementById("op-words").textContent);
  const box = document.createElement("p");
  box.id = "op-silent";
  box.setAttribute("role", "alert");
  let waiting = setTimeout(tell, PATIENCE);

  function tell() {
    const own = navigator.languages.map((language) => language.split("-")[0]);
    box.lang = own.find((language) => language in words) ?? "en";
    document.body.append(box);
    box.textContent = words[box.lang];
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
