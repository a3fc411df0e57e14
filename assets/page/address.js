// Binds the page to the lab at its own address, whatever a link says. viser takes the address of its
// server from the query, although a server can run scripts in the page, and plays any recording named
// there. Without an address in the query, viser would use this page's without its last slash, which a
// proxy that serves the lab in a folder answers with a redirection. viser also writes the server's
// address into the query, from where a user would copy it.
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
