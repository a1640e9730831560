"""Local server of the page, restricted to one address and one port.

viser's own server uses the next port if one is taken, prints it on standard output, lets any
website talk to it, and opens a tunnel to its makers' server on request of a page. This server does
none of that: the port is checked in advance, requests must come from the page itself and know its
token, and a Content-Security-Policy forbids the page to run or fetch anything from elsewhere.
"""

from __future__ import annotations

import errno
import hmac
import html
import ipaddress
import logging
import os
import re
import secrets
import socket
from collections.abc import Callable
from functools import partial
from http import HTTPStatus
from http.client import HTTPConnection
from pathlib import Path
from queue import Empty, SimpleQueue
from threading import Event
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

from ..errors import AddressError
from ..extras import make_missing_error

if TYPE_CHECKING:
    import viser

LOOPBACK = "127.0.0.1"
PORT = 8733
"""Default port: "URDF" on a phone keypad."""

TRIED = 20
"""Number of ports tried from there. Chosen, no source."""

_SECONDS = 10.0  # timeout of the first request to the server; chosen

_STYLE = Path(__file__).with_name("page.css")
_ORIGINAL_TITLE = b"<title>Viser</title>"


def is_loopback(host: str) -> bool:
    """Tell whether an address is reachable from this computer only."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return False


def make_url(host: str, port: int, token: str) -> str:
    """Return the URL of the page; an IPv6 address is put in brackets."""
    return f"http://{f'[{host}]' if ':' in host else host}:{port}/{token}/"


def make_token() -> str:
    """Return a random text of 128 bits for the address of one page."""
    return secrets.token_urlsafe(16)


def choose_port(host: str, requested: int | None) -> int:
    """Return a free port: the requested one, or the first from ``PORT`` on.

    Raises:
        AddressError: The requested port or all tried ports are taken, or the host is not an address
            of this computer.
    """
    if requested is not None:
        if not is_free(host, requested):
            raise AddressError(
                f"port {requested} of {host} is in use; choose another one, or omit --port for the "
                "next free port"
            )
        return requested
    for port in range(PORT, PORT + TRIED):
        if is_free(host, port):
            return port
    raise AddressError(
        f"ports {PORT} to {PORT + TRIED - 1} of {host} are in use; choose another one with --port"
    )


def is_free(host: str, port: int) -> bool:
    """Tell whether a server could listen on the port.

    Raises:
        AddressError: The port is not permitted, or the host is not an address of this computer.
    """
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
        for family, kind, protocol, _, where in found:
            with socket.socket(family, kind, protocol) as trial:
                trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                trial.bind(where)
                trial.listen(1)
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            return False
        if error.errno in (errno.EACCES, errno.EPERM):
            raise AddressError(
                f"port {port} of {host} requires privileges; choose a port above 1023 with --port"
            ) from None
        raise AddressError(
            f"'{host}' is not an address of this computer ({error.strerror}); use --host {LOOPBACK}"
            " for this computer only, or --host 0.0.0.0 for all networks"
        ) from None
    return True


def start(host: str, port: int, token: str, title: Callable[[], str]) -> viser.ViserServer:
    """Start the server on an address.

    Raises:
        MissingDependency: viser is not installed.
        AddressError: Another process took the port in the meantime, or the server cannot be
            restricted.
    """
    try:
        import rich
        import viser
    except ImportError:
        raise make_missing_error("viser", "the page of 'urdftool view'") from None

    class Server(viser.ViserServer):
        """viser's server without its tunnel."""

        def request_share_url(self, verbose: bool = True) -> None:
            """Skip the request, so that no tunnel to the internet is opened."""

    rich.reconfigure(quiet=True)  # viser prints its address and more on standard output
    logging.getLogger("websockets").setLevel(logging.CRITICAL)
    server = Server(host=host, port=port, verbose=False)
    try:
        if server.get_port() != port:
            raise AddressError(f"another program now uses port {port} of {host}; try again")
        _guard(server, partial(_handle_request, host, token, title))
    except BaseException:
        server.stop()
        raise
    return server


def _guard(server: Any, handle: Callable[..., Any]) -> None:
    """Install a request handler in a server that has just started.

    viser accepts no request handler. The server of websockets has one as an attribute, and each
    connection refers to its server, so this function makes the first connection. Clients that
    connected before the handler was set got an empty page and are disconnected.

    Raises:
        AddressError: This version of viser or websockets does not support it.
    """
    import viser
    from websockets.exceptions import WebSocketException
    from websockets.sync.client import connect
    from websockets.typing import Subprotocol

    inner = server._websock_server
    servers: SimpleQueue[Any] = SimpleQueue()

    def note_server(client: Any) -> None:
        if not guarded.is_set():
            servers.put(inner._live_connections[client.client_id].server)

    guarded = Event()
    inner.on_client_connect(note_server)
    host, port = server.get_host(), server.get_port()
    here = {"0.0.0.0": LOOPBACK, "": LOOPBACK, "::": "::1"}.get(host, host)
    version = f"viser-v{viser.__version__}"
    try:
        with connect(
            make_url(here, port, "").replace("http", "ws", 1),
            sock=socket.create_connection((here.strip("[]"), port), _SECONDS),
            subprotocols=[Subprotocol(version)],
        ):
            library = servers.get(timeout=_SECONDS)
        library.process_request = partial(handle, library.process_request)
        guarded.set()
        inner.disconnect_all_clients()
        if not _refuses_others(here, port):
            raise AddressError("this version of viser cannot refuse requests without the token")
    except (AttributeError, Empty, OSError, WebSocketException) as error:
        raise AddressError(f"this version of viser cannot serve the page: {error}") from None


def _refuses_others(host: str, port: int) -> bool:
    """Tell whether a request without the token is refused."""
    link = HTTPConnection(host.strip("[]"), port, timeout=_SECONDS)
    try:
        link.request("GET", "/")
        return link.getresponse().status == HTTPStatus.FORBIDDEN
    finally:
        link.close()


def _handle_request(
    host: str, token: str, title: Callable[[], str], answer: Any, connection: Any, request: Any
) -> Any:
    """Refuse requests of other websites or without the token; add title and policy to the page."""
    hosts, origins, upgrades = map(request.headers.get_all, ("Host", "Origin", "Upgrade"))
    if len(hosts) != 1 or len(origins) > 1 or len(upgrades) > 1:
        return connection.respond(400, "One Host, and at most one Origin and Upgrade.\n")
    own_host = hosts[0]
    try:
        name = urlsplit(f"//{own_host}").hostname or ""
        strange = any(urlsplit(origin).netloc != own_host for origin in origins)
    except ValueError:  # brackets without an address of IPv6
        return connection.respond(400, "The Host or Origin header is malformed.\n")
    if is_loopback(host) and not is_loopback(name):
        return connection.respond(403, f"This page is served for {host} only.\n")
    if strange:
        return connection.respond(403, "Requests of other websites are refused.\n")
    given, _, rest = request.path.partition("?")[0].removeprefix("/").partition("/")
    if not hmac.compare_digest(os.fsencode(given), token.encode()):
        return connection.respond(403, "Open the address that 'urdftool view' printed.\n")
    request.path = f"/{rest}"
    if upgrades and upgrades[0].lower() == "websocket":
        return answer(connection, request)
    path = unquote(request.path).replace("\\", "/")
    if ".." in path.split("/") or not path.isprintable():
        return connection.respond(404, "Page not found.\n")
    while "Accept-Encoding" in request.headers:
        del request.headers["Accept-Encoding"]
    response = answer(connection, request)
    if response is not None:
        nonce = make_token()
        response.body = _write_head(response.body or b"", title(), nonce)
        response.headers["Content-Security-Policy"] = make_policy(own_host, nonce)
        response.headers["Referrer-Policy"] = "no-referrer"
        response.headers["X-Content-Type-Options"] = "nosniff"
        response.headers["Cache-Control"] = "no-store"
        if "Content-Length" in response.headers:
            del response.headers["Content-Length"]
        response.headers["Content-Length"] = str(len(response.body))
    return response


_SPREAD_NONCE = b"""<script nonce="NONCE">(() => {
  const nonce = document.currentScript.nonce, create = Document.prototype.createElement;
  Document.prototype.createElement = function (...given) {
    const made = create.apply(this, given);
    if (made instanceof HTMLScriptElement || made instanceof HTMLStyleElement) made.nonce = nonce;
    return made;
  };
})();</script>"""
"""Gives the nonce to the elements that the script of the library creates: its program, which it
unpacks, and its style sheets. Elements that are written as HTML get none.
"""


def _write_head(body: bytes, title: str, nonce: str) -> bytes:
    """Set the title of the page of viser, and the nonce of the scripts that are written in it."""
    body = body.replace(_ORIGINAL_TITLE, f"<title>{html.escape(title)}</title>".encode(), 1)
    body = body.replace(b"<script ", b'<script nonce="NONCE" ')
    style = b'<style nonce="NONCE">' + _STYLE.read_bytes() + b"</style>"
    body = body.replace(b"<head>", b"<head>" + _SPREAD_NONCE + style, 1)
    return body.replace(b"NONCE", nonce.encode())


def make_policy(own_host: str, nonce: str) -> str:
    """Return the Content-Security-Policy: the page, its embedded data and its websocket only.

    Scripts and style sheets need the nonce. ``wasm-unsafe-eval`` is for the program that unpacks
    the page, which is WebAssembly; it does not allow ``eval`` of text. What the library does with
    ``eval``, Gaussian splats and Plotly, does not occur on the page.
    """
    safe = own_host if re.fullmatch(r"[\w.:\[\]-]+", own_host, re.ASCII) else ""
    return "; ".join(
        (
            "default-src 'none'",
            f"script-src 'nonce-{nonce}' 'wasm-unsafe-eval'",
            f"style-src 'nonce-{nonce}'",
            "worker-src blob: data:",
            "img-src data: blob:",
            "font-src data:",
            f"connect-src data: blob: ws://{safe}",
            "base-uri 'none'",
            "frame-ancestors 'none'",
            "form-action 'none'",
        )
    )
