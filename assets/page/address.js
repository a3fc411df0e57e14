// The lab is at this page's own address, whatever a link says. viser takes the address of its server
// from the query, and a server may run scripts in the page; it also plays any recording that is named
// there. Without one, it would ask for this address without its last slash, which a proxy that serves
// the lab in a folder answers with a redirection. It writes the server's address into the query, too,
// from where a user would copy it.
(() => {
  "use strict";

  const SERVER = "websocket";
  const FOREIGN = [SERVER, "playbackPath", "dummyWindowDimensions", "dummyWindowTitle"];

  const replace = history.replaceState.bind(history);

  function cleaned(address) {
    const url = new URL(address ?? "", location.href);
    const given = FOREIGN.filter((name) => url.searchParams.has(name));
    given.forEach((name) => url.searchParams.delete(name));
    return given.length === 0 ? address : url.href;
  }

  history.replaceState = (state, title, address) => replace(state, title, cleaned(address));

  const own = new URL(cleaned(location.href));
  const scheme = own.protocol === "https:" ? "wss:" : "ws:";
  own.searchParams.set(SERVER, `${scheme}//${own.host}${own.pathname}`);
  replace(null, "", own);
})();
